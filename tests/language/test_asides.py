"""Laughter and *to be honest* are asides if they stand beside a statement, not in it."""

import pytest

from ravestate.language.acts import is_playful
from ravestate.language.asides import asides
from ravestate.language.normal import normalise


def without_asides(text: str) -> str:
    for start, end in sorted(asides(text), reverse=True):
        text = text[:start] + text[end:]
    return text


@pytest.mark.parametrize(
    ("text", "rest"),
    [
        ("I painted a dragon lol.", "I painted a dragon."),
        ("I painted a dragon, hahaha!", "I painted a dragon!"),
        ("I painted a dragon LOL haha", "I painted a dragon"),
        ("She is mad lmao. So is he lol.", "She is mad. So is he."),
        ("Lol I have a cat.", "I have a cat."),
        ("Lol Jonas has a cat.", "Jonas has a cat."),
        ("I like it, to be honest.", "I like it."),
        ("To be honest, I like it lol.", "I like it."),
    ],
)
def test_an_aside_at_the_start_or_end_of_a_sentence_is_found(text: str, rest: str) -> None:
    assert without_asides(text) == rest


@pytest.mark.parametrize(
    "text",
    [
        "Lol.",
        "Haha, lol!",
        "What is lol?",
        "What does lol mean?",
        "He said lol.",
        "My dog is called Lol.",
        "We play LoL.",
        "I like the lol cats.",
        "I want to be honest.",
        "He lives in a hahaus.",
    ],
)
def test_words_that_belong_to_a_statement_are_no_asides(text: str) -> None:
    assert list(asides(text)) == []


def test_laughter_is_also_a_sign_of_banter() -> None:
    assert is_playful("You are hopeless hahaha") and not is_playful("You are hopeless")


@pytest.mark.parametrize(
    ("typed", "normal"),
    [
        ("i like it tbh", "I like it, to be honest."),
        ("tbh i like it", "To be honest, I like it."),
        ("i like it tbh and so does he", "I like it, to be honest, and so does he."),
        ("tbh", "To be honest."),
        ("i like it, tbh.", "I like it, to be honest."),
        ("i like it. tbh. really", "I like it. To be honest. Really."),
        ("i want to be honest", "I want to be honest."),
    ],
)
def test_the_normal_form_sets_a_short_aside_off_by_commas(typed: str, normal: str) -> None:
    assert normalise(typed).text == normal
