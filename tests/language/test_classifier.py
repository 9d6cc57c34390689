"""The classifier: one class for a whole text."""

from __future__ import annotations

from pathlib import Path

from hypothesis import given
from hypothesis import strategies as st

from ravestate.language.classifier import Classifier
from ravestate.language.network import Network


def test_a_classifier_finds_no_class_before_it_is_loaded(tmp_path: Path) -> None:
    unloaded = Classifier("answers", Network(tmp_path / "missing.onnx"))
    assert unloaded.best("Yes.") == ("", 0.0)
    assert unloaded.ranked("Yes.") == unloaded.labels == []


def test_the_best_class_has_the_greatest_probability() -> None:
    answers = Classifier("answers")
    answers.load()
    name, probability = answers.best("You bet I do!")
    assert name == "yes 2"
    assert 1 / 6 < probability <= 1


@given(st.text(max_size=400))
def test_every_text_has_a_class(text: str) -> None:
    answers = Classifier("answers")
    answers.load()
    name, probability = answers.best(text)
    assert name in (("yes 2", "yes 1", "no 2", "no 1", "unsure", "-") if text.strip() else ("",))
    assert 0 <= probability <= 1.001
