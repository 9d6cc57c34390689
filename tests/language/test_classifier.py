"""The classifier: one class for a whole text."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from ravestate.errors import PlatformError
from ravestate.language.classifier import Classifier
from ravestate.modules.meta.nlp.answer import answers


def test_a_classifier_finds_no_class_before_it_is_loaded(tmp_path: Path) -> None:
    assert Classifier(tmp_path / "missing.onnx").best("Yes.") == ("", 0.0)


def test_the_best_class_has_the_greatest_probability() -> None:
    answers().load()
    name, probability = answers().best("You bet I do!")
    assert name == "yes 2"
    assert 1 / 6 < probability <= 1


@given(st.text(max_size=400))
def test_every_text_has_a_class(text: str) -> None:
    answers().load()
    name, probability = answers().best(text)
    assert name in ("yes 2", "yes 1", "no 2", "no 1", "unsure", "-", "")
    assert 0 <= probability <= 1.001


def test_a_missing_file_says_so(tmp_path: Path) -> None:
    with pytest.raises(PlatformError, match="is broken"):
        Classifier(tmp_path / "missing.onnx").load()
