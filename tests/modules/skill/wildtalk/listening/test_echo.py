"""Statements from the agent's view. The quality set ``turned_rows`` measures more of them."""

import pytest

from ravestate.modules.skill.wildtalk.listening.echo import Told, told_in
from ravestate.modules.skill.wildtalk.listening.material import material

from .conftest import seen


def told(text: str) -> Told | None:
    return max(told_in(seen(text), material().living), key=lambda one: one.start, default=None)


@pytest.mark.parametrize(
    ("subject", "turned", "person"),
    [("I", "you", "mine"), ("my ferret", "your ferret", "theirs"), ("our roof", "your roof", "thing")],
)
@pytest.mark.parametrize(
    ("verb", "tense"), [("fell off a wall", "past"), ("will fall soon", "plan"), ("used to fall", "once")]
)
def test_in_a_statement_my_becomes_your_and_the_tense_is_found(
    subject: str, turned: str, person: str, verb: str, tense: str
) -> None:
    found = told(f"{subject} {verb}")
    assert found is not None
    assert (found.echo, found.subject, found.tense) == (f"{turned} {verb}", person, tense)


@pytest.mark.parametrize(
    "text", [f"I have {' and '.join(f'box {word}' for word in 'abcdefghijkl')} at home", "you can get stamps there"]
)
def test_a_long_statement_or_a_you_that_means_anybody_is_not_repeated(text: str) -> None:
    found = told(text)
    assert found is not None
    assert not found.echo
