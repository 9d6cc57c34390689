"""The gate refuses sentences that a model must not say. The quality set ``refused_rows`` has more sentences."""

import pytest

from ravestate.modules.meta.nlp.pipeline import pipeline
from ravestate.modules.skill.wildtalk.gate import Gate

KNOWN = {"home": ("Hannover",), "name": ("Marlene",), "sister": ("Rosa",), "age": ("33",)}


@pytest.fixture(scope="module", autouse=True)
def _loaded() -> None:
    pipeline("").load()


def gate(heard: str = "I moved house last week.", said: tuple[str, ...] = ()) -> Gate:
    return Gate("Ravestate", heard, said=said, known=KNOWN, pipeline=pipeline(""))


@pytest.mark.parametrize(
    ("sentence", "reason"),
    [
        ("Look at {} for more.", "a link"),
        ("User: {} is a house.", "the mark of a speaker"),
        ("<b>{}</b> is a nice house.", "markup or code"),
        ("{} h\ufffduse.", "junk"),
    ],
)
def test_the_gate_refuses_what_no_agent_may_say(sentence: str, reason: str) -> None:
    for word in ("www.example.org", "https://example.org") if reason == "a link" else ("This", "Ravestate"):
        assert gate().refuse(sentence.format(word)) == reason


def test_a_sentence_in_which_the_agent_has_another_name_is_refused() -> None:
    assert [gate().refuse(f"My name is {name}.") for name in ("Marlene", "Tom")] == ["a wrong name", "a wrong name"]
    assert gate("What is your name?").refuse("My name is Ravestate.") == ""


@pytest.mark.parametrize(
    ("claim", "true", "false"),
    [
        ("You live in {}.", "Hannover", "Berlin"),
        ("Your sister {} will like the house.", "Rosa", "Anna"),
        ("You are {} years old.", "33", "52"),
    ],
)
def test_only_claims_that_memory_contradicts_are_refused(claim: str, true: str, false: str) -> None:
    assert gate().refuse(claim.format(false)) == "a claim that memory contradicts"
    assert gate().refuse(claim.format(true)) != "a claim that memory contradicts"


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
