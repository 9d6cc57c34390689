"""The question that ends an utterance, and the remarks before it. `tests/quality` measures more utterances."""

from __future__ import annotations

import pytest

from ravestate.modules.meta.nlp.analysis import analyse
from ravestate.modules.meta.nlp.closing import MOST, Closing
from ravestate.modules.meta.nlp.pipeline import pipeline


def closing(text: str) -> Closing | None:
    return analyse(text, pipeline("")).closing


def test_the_words_before_a_question_are_remarks_unless_one_of_them_tells_something() -> None:
    for before, remarks in (("Wow.", True), ("Wow. haha funny!!", True), ("Wow. My cat is called Biscuit.", False)):
        found = closing(f"{before} How old are you?")
        assert found is not None
        assert (found.text, found.remarks) == ("How old are you?", remarks)


@pytest.mark.parametrize(
    "text", ["", "How old are you?", "I can't sleep. Is that normal?", "I live in Leeds. It is cold."]
)
def test_an_utterance_without_a_complete_question_after_other_words_has_no_closing(text: str) -> None:
    assert closing(text) is None


@pytest.mark.parametrize("back", ["Do you?", "And you?", "What about you?"])
def test_a_question_such_as_and_you_repeats_the_users_statement_as_a_question(back: str) -> None:
    found = closing(f"I love jazz. {back}")
    assert found is not None
    assert found.returned
    assert found.text == "Do you love jazz?"


def test_a_long_text_is_not_reduced_to_its_last_question() -> None:
    assert closing("Nice. " * MOST + "How old are you?") is None


def test_a_question_outweighs_the_remark_before_it_but_not_itself() -> None:
    found = closing("Cool story. Who wrote Hamlet?")
    assert found is not None
    assert found.outweighs("Cool story.")
    assert not found.outweighs("Who wrote Hamlet?")
