"""The tagger: labels for the words of a text."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from ravestate.language.network import Network, network
from ravestate.language.tagger import Tag, Tagger, tagger


@pytest.fixture(scope="module")
def loaded() -> Tagger:
    found = tagger()
    found.load()
    return found


def found_in(tags: list[Tag]) -> set[tuple[str, str, bool]]:
    return {(tag.label, tag.text, tag.negated) for tag in tags}


def test_a_tagger_finds_nothing_before_it_is_loaded(tmp_path: Path) -> None:
    assert Tagger(Network(tmp_path / "missing.onnx")).tags("I live in Leeds.") == []


def test_several_values_of_a_text_have_their_labels(loaded: Tagger) -> None:
    found = found_in(loaded.tags("My name is Ada, I live in Leeds and I work as a nurse."))
    assert found == {("name", "Ada", False), ("home", "Leeds", False), ("occupation", "nurse", False)}


def test_a_denied_value_is_negated(loaded: Tagger) -> None:
    assert found_in(loaded.tags("I live in Bremen, not in Hannover.")) == {
        ("home", "Bremen", False),
        ("home", "Hannover", True),
    }


def test_the_context_decides_what_a_fragment_means(loaded: Tagger) -> None:
    assert found_in(loaded.tags("Hannover.", "home")) == {("home", "Hannover", False)}
    assert found_in(loaded.tags("Hannover.", "origin")) == {("origin", "Hannover", False)}


def test_an_unknown_context_counts_as_none(loaded: Tagger) -> None:
    assert loaded.tags("I live in Leeds.", "weather") == loaded.tags("I live in Leeds.")


@given(st.text(max_size=200))
def test_tags_lie_in_the_text_one_after_the_other(text: str) -> None:
    last = 0
    tagger().load()
    for tag in tagger().tags(text):
        assert last <= tag.start < tag.end <= len(text)
        assert text[tag.start : tag.end] == tag.text
        assert 0 <= tag.score <= 1.001
        last = tag.end


def test_a_network_that_finishes_loading_during_a_call_causes_no_error() -> None:
    """Another thread may load the network between the look at its labels and the reading."""

    class Late(Network):
        asked = 0

        @property
        def loaded(self) -> bool:
            self.asked += 1
            return self.asked > 1

        def labels(self, head: str) -> list[str]:
            return network().labels(head) if self.loaded else []

        def read(self, *arguments: Any, **named: Any) -> Any:
            return network().read(*arguments, **named) if self.loaded else {}

    network().load()
    late = Tagger(Late(Path("missing.onnx")))
    assert late.tags("I live in Leeds.") == []
    assert found_in(late.tags("I live in Leeds.")) == {("home", "Leeds", False)}
