"""The question that ends an utterance, and the remarks before it."""

from __future__ import annotations

import pytest

from ravestate.modules.meta.nlp.analysis import analyse
from ravestate.modules.meta.nlp.closing import MOST, Closing
from ravestate.modules.meta.nlp.pipeline import pipeline


def closing(text: str) -> Closing | None:
    return analyse(text, pipeline("")).closing


@pytest.mark.parametrize("remark", ["Wow.", "haha funny!!", "That's sad.", "You're silly.", "Ok thanks."])
def test_a_remark_before_a_question_leaves_the_question_to_be_answered(remark: str) -> None:
    found = closing(f"{remark} How old are you?")
    assert found is not None
    assert found.text == "How old are you?"
    assert found.remarks


@pytest.mark.parametrize("told", ["My cat is called Biscuit.", "I had a terrible day.", "I'm nine."])
def test_a_sentence_that_tells_the_agent_something_is_not_a_remark(told: str) -> None:
    found = closing(f"{told} Do you have pets?")
    assert found is not None
    assert not found.remarks


@pytest.mark.parametrize(
    "text",
    [
        "How old are you?",
        "I can't sleep. Is that normal?",
        "We got a puppy. What should we call him?",
        "I live in Leeds. It is cold.",
        "",
    ],
)
def test_a_question_that_stands_alone_or_needs_the_words_before_it_is_not_separated(text: str) -> None:
    assert closing(text) is None


@pytest.mark.parametrize(
    ("text", "asked"),
    [
        ("I love jazz. Do you?", "Do you love jazz?"),
        ("I play the violin, and you?", "Do you play the violin?"),
        ("I can't swim. Can you?", "Can you swim?"),
        ("I went to the zoo, did you?", "Did you go to the zoo?"),
        ("I'm from Leeds. What about you?", "Are you from Leeds?"),
    ],
)
def test_and_you_becomes_a_question_about_what_the_user_has_just_said(text: str, asked: str) -> None:
    found = closing(text)
    assert found is not None
    assert found.returned
    assert found.text == asked


def test_a_long_text_is_not_reduced_to_its_last_question() -> None:
    assert closing("Nice. " * MOST + "How old are you?") is None


def test_a_question_outweighs_the_remark_before_it_but_not_itself() -> None:
    found = closing("Cool story. Who wrote Hamlet?")
    assert found is not None
    assert found.outweighs("Cool story.")
    assert not found.outweighs("Who wrote Hamlet?")
