"""The statement that the listener takes up, and its highlight. The quality set ``highlights_rows`` has more of them."""

from __future__ import annotations

import random

import pytest

from ravestate.modules.skill.wildtalk.listening import State
from ravestate.modules.skill.wildtalk.listening.echo import Told
from ravestate.modules.skill.wildtalk.listening.material import material
from ravestate.modules.skill.wildtalk.listening.taking_up import Taken, replies, taken_from

from .conftest import seen

TENSES = ("past", "now", "plan", "might", "once", "not")
PERSONS = ("mine", "theirs", "thing", "yours", "piece")
MOODS = ("", "sad", "angry", "glad", "funny", "tired", "quiet")


def taken(text: str, known: str = "") -> Taken | None:
    return taken_from(seen(text), material().living, known)


@pytest.mark.parametrize("highlight", ["three rusty lanterns", "a garden gnome", "two accordions"])
def test_the_phrase_that_says_most_is_the_highlight_in_any_tense(highlight: str) -> None:
    for frame, tense in (
        ("my uncle found {}", "past"),
        ("we are going to buy {}", "plan"),
        ("there is {} here", "now"),
    ):
        found = taken(frame.format(highlight))
        assert found is not None
        assert highlight in found.highlight
        assert found.told.tense == tense


def test_a_phrase_from_the_previous_utterance_is_not_the_highlight_again() -> None:
    first = taken("there is a badger in the greenhouse")
    again = taken("the badger ate my marrows", "there is a badger in the greenhouse")
    assert first is not None and "badger" in first.highlight
    assert again is not None and "badger" not in again.highlight


@pytest.mark.parametrize("frame", ["I don't have {}", "if I had {}", "is there {} in the greenhouse?"])
def test_what_is_denied_imagined_or_asked_is_no_highlight(frame: str) -> None:
    for thing in ("a parrot", "a rusty trombone"):
        found = taken(frame.format(thing))
        assert found is None or not found.highlight


@pytest.mark.parametrize("text", ["my cousin Rosalind", "I met Rosalind", "bye robot"])
def test_a_persons_name_alone_is_no_highlight(text: str) -> None:
    found = taken(text)
    assert found is None or found.highlight.lower() != "rosalind"
    assert found is None or "robot" not in found.highlight.lower()


@pytest.mark.parametrize("mood", MOODS)
@pytest.mark.parametrize("person", PERSONS)
@pytest.mark.parametrize("tense", TENSES)
def test_there_are_replies_for_each_person_tense_and_mood(person: str, tense: str, mood: str) -> None:
    told = Taken(Told("the roof leaks", person, tense), "the roof")
    groups = list(replies(told, material().taking_up, mood, State(), random.Random(0)))
    assert sum(len(lines) for group in groups for lines in group) >= 2
