"""The gate refuses sentences that a model must not say, and passes all others."""

import pytest

from ravestate.modules.meta.nlp.pipeline import pipeline
from ravestate.modules.skill.wildtalk.gate import Gate

KNOWN = {"home": ("Hannover",), "name": ("Marlene",), "sister": ("Rosa",), "age": ("33",)}

FITTING = [
    ("I have a new bicycle.", "Oh nice, where will you ride it first?"),
    ("My uncle is in hospital.", "I hope he gets well soon."),
    ("We lost the match.", "That is a pity, but there will be another one."),
    ("I'm going to the dentist tomorrow.", "I hope it won't hurt."),
    ("What do you do all day?", "I listen, and I collect words."),
    ("My flat is too small.", "Maybe a bigger one turns up soon."),
    ("I baked bread today.", "Fresh bread must smell wonderful."),
    ("You are very nice.", "Thank you, so are you!"),
    ("I have nothing to do.", "Shall I tell you a joke?"),
    ("It is so hot today.", "Then drink enough water."),
    ("I don't like my job.", "What would you rather do?"),
    ("ok", "Good."),
]


@pytest.fixture(scope="module", autouse=True)
def _loaded() -> None:
    pipeline("").load()


def gate(heard: str = "I moved house last week.", said: tuple[str, ...] = ()) -> Gate:
    return Gate("Ravestate", heard, said=said, known=KNOWN, pipeline=pipeline(""))


@pytest.mark.parametrize(
    ("sentence", "reason"),
    [
        ("Look at https://example.org for more.", "a link"),
        ("Visit www.example.org now.", "a link"),
        ("User: I moved house.", "the mark of a speaker"),
        ("Use `print` for that.", "markup or code"),
        ("<b>Nice</b> house.", "markup or code"),
        ("- moving boxes", "markup or code"),
        ("Houuuuuuse.", "junk"),
        ("Nice h\ufffduse.", "junk"),
        ("Ich bin nicht sehr gut heute.", "another language"),
        ("I moved house last week.", "a repetition"),
        ("A new house is a new house is a new house.", "a repetition within itself"),
        ("My name is Marlene.", "a wrong name"),
        ("I am Tom.", "a wrong name"),
        ("You live in Berlin.", "a claim that memory contradicts"),
        ("Your sister Anna will like the house.", "a claim that memory contradicts"),
        ("You are 52 years old.", "a claim that memory contradicts"),
        ("As an AI language model, I do not live in a house.", "out of character (assistant)"),
        ("I moved house with my wife last year.", "out of character (human_life)"),
        ("The Roman empire fell in 476.", "no answer to what was said"),
    ],
)
def test_the_gate_refuses_a_sentence_and_names_the_reason(sentence: str, reason: str) -> None:
    assert gate().refuse(sentence) == reason


@pytest.mark.parametrize(
    "sentence",
    [
        "How do you like your new house?",
        "I am Ravestate, a robot that never moves.",
        "You live in Hannover now.",
        "Your sister Rosa must be happy about your new house.",
    ],
)
def test_a_sentence_that_contradicts_no_known_fact_passes(sentence: str) -> None:
    assert gate().refuse(sentence) == ""


@pytest.mark.parametrize(("heard", "answer"), FITTING)
def test_a_fitting_answer_passes(heard: str, answer: str) -> None:
    assert gate(heard).refuse(answer) == ""


def test_a_sentence_that_was_said_before_is_refused() -> None:
    assert gate(said=("Moving is hard work. I know.",)).refuse("Moving is hard work!") == "a repetition"


def test_while_an_answer_grows_only_its_whole_sentences_are_admitted() -> None:
    checked = gate()
    assert checked.admit("A new hou", last=False) == ("", False)
    assert checked.admit("A new house! How exc", last=False) == ("A new house!", False)
    assert checked.admit("A new house! How exciting.", last=True) == ("A new house! How exciting.", False)


def test_after_a_refused_sentence_no_further_sentence_is_admitted() -> None:
    checked = gate()
    assert checked.admit("A new house! See www.example.org. ", last=True) == ("A new house!", True)
    assert checked.reason == "a link"
    assert checked.admit("A new house! See www.example.org. Nice.", last=True) == ("A new house!", True)
