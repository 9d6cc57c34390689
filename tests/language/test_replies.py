"""The network that grades replies. The quality sets ``responses_rows`` and ``responses_grades`` measure it."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from ravestate.language.network import Network
from ravestate.language.replies import Replies, replies
from ravestate.modules.meta.nlp.analysis import analyse, load_models
from ravestate.modules.meta.nlp.pipeline import pipeline


@pytest.fixture(scope="module", autouse=True)
def _models() -> None:
    load_models()


def test_no_reply_has_a_grade_before_the_network_is_loaded(tmp_path: Path) -> None:
    unloaded = Replies(Network(tmp_path / "missing.onnx"))
    assert unloaded.grades("hello") == unloaded.kinds("hello") == {}


@given(st.text(max_size=400), st.text(max_size=400), st.text(max_size=400))
def test_grades_go_from_0_to_2_and_kinds_are_probabilities(text: str, before: str, said: str) -> None:
    grades, kinds = replies().grades(text, before, said), replies().kinds(text, before, said)
    assert all(0 <= grade <= 2 for grade, _ in grades.values())
    assert bool(grades) == bool(kinds) == bool(text.strip())
    assert not kinds or sum(kinds.values()) == pytest.approx(1, abs=0.01)


def test_the_texts_before_an_utterance_change_its_grades() -> None:
    alone = replies().kinds("yes")
    assert replies().kinds("yes", "my dog died") != alone != replies().kinds("yes", "", "Shall we talk about it?")


@pytest.mark.parametrize("text", ["so that's gone now", "got like 20 min before I'm back on the line"])
def test_words_that_resemble_a_farewell_are_none_if_no_farewell_suits(text: str) -> None:
    assert "intent_bye" not in analyse(text, pipeline("")).acted


@pytest.mark.parametrize("text", ["ok bye", "gotta go, my bus is here", "see you tomorrow", "well, off to bed"])
def test_farewells_are_recognised(text: str) -> None:
    assert "intent_bye" in analyse(text, pipeline("")).acted
