"""Statements from the agent's view."""

import pytest

from ravestate.modules.skill.wildtalk.listening.echo import Told, told_in
from ravestate.modules.skill.wildtalk.listening.material import material

from .conftest import seen


def told(text: str) -> Told | None:
    return max(told_in(seen(text), material().living), key=lambda one: one.start, default=None)


@pytest.mark.parametrize(
    ("text", "echo", "subject", "tense"),
    [
        ("my ferret bit me", "your ferret bit you", "theirs", "past"),
        ("I was at the fair with our aunt", "you were at the fair with your aunt", "mine", "now"),
        ("so i'm a locksmith now", "you're a locksmith now", "mine", "now"),
        ("well the roof is leaking again", "the roof is leaking again", "thing", "now"),
        ("I am going to visit him on Monday", "you are going to visit him on Monday", "mine", "plan"),
        ("She used to whistle in the kitchen", "she used to whistle in the kitchen", "theirs", "once"),
        ("I think I'll ask her", "you'll ask her", "mine", "plan"),
        ("He was hurt in a mine.", "he was hurt in a mine", "theirs", "past"),
        ("they took my kite and hid it", "they took your kite and hid it", "theirs", "past"),
        ("you sound like my uncle", "I sound like your uncle", "yours", "now"),
        ("She gave us a jar as a thank you", "she gave you a jar as a thank you", "theirs", "past"),
        ("forty tin soldiers in a box", "forty tin soldiers in a box", "piece", "now"),
    ],
)
def test_a_statement_is_repeated_from_the_agents_view(text: str, echo: str, subject: str, tense: str) -> None:
    found = told(text)
    assert found is not None
    assert (found.echo, found.subject, found.tense) == (echo, subject, tense)


@pytest.mark.parametrize("text", ["hello", "yes", "Go away!", "what is this?", "I told you so", "hm"])
def test_words_without_a_statement_and_words_to_the_agent_are_not_repeated(text: str) -> None:
    found = told(text)
    assert found is None or not found.echo


@pytest.mark.parametrize(
    "text", [f"I have {' and '.join(f'box {word}' for word in 'abcdefghijkl')} at home", "you can get stamps there"]
)
def test_a_long_statement_and_a_statement_about_people_in_general_are_not_repeated(text: str) -> None:
    found = told(text)
    assert found is not None
    assert not found.echo
