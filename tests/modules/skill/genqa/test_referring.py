"""Questions that refer to the one before are completed by it, or stay as they are."""

from __future__ import annotations

import pytest

from ravestate.modules.skill.genqa.referring import Before, completed, other_wordings

POPULATION = Before("what is the population of Austria", "Austria", 0.0)


@pytest.mark.parametrize(
    ("heard", "meant"),
    [
        ("And its capital?", "Austria's capital"),
        ("what is its capital?", "what is Austria's capital"),
        ("and the capital?", "the capital of Austria"),
        ("how many people live there?", "how many people live in Austria"),
        ("And of Spain?", "what is the population of Spain"),
        ("and hungary", "what is the population of hungary"),
        ("Thank you. What about the Netherlands?", "what is the population of the Netherlands"),
        ("and in the United States?", "what is the population of the United States"),
    ],
)
def test_what_is_meant_is_written_out_and_without_a_question_before_nobody_knows(
    heard: str, meant: str
) -> None:
    assert completed(heard, POPULATION) == meant
    assert completed(heard, None) is None


@pytest.mark.parametrize(
    "heard",
    [
        "What is the capital of France?",
        "And who wrote Hamlet?",
        "how many countries are there in Africa?",
        "Is there life on Mars?",
        "how do plants make their food?",
        "which country has its capital in the mountains?",
        "when did it start to rain",
        "",
        "?",
        "there" * 50_000,
    ],
)
def test_what_stands_by_itself_stays(heard: str) -> None:
    assert completed(heard, POPULATION) == completed(heard, None) == heard


@pytest.mark.parametrize(
    "heard", ["how about a game?", "and you?", "what about my name", "and then a very long story about it?"]
)
def test_what_asks_for_something_else_is_left_to_others(heard: str) -> None:
    assert completed(heard, POPULATION) is None


@pytest.mark.parametrize(
    ("before", "subject"),
    [
        (Before("population of the usa", "United States", 0.0), "the usa"),
        (Before("the capital of the netherlands", "Netherlands", 0.0), "the netherlands"),
        (Before("who wrote Hamlet", "Arts", 0.0), ""),
    ],
)
def test_what_a_question_is_about_is_in_its_own_words(before: Before, subject: str) -> None:
    assert before.subject == subject


def test_what_decides_a_question_of_yes_or_no_is_another_question() -> None:
    assert list(other_wordings("is Peru in Africa")) == ["where is Peru"]
    assert list(other_wordings("who is in Africa")) == []
