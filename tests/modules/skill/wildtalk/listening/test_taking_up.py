"""The statement that the listener takes up, and its highlight."""

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


@pytest.mark.parametrize(
    ("text", "highlight", "tense"),
    [
        ("My uncle gave me three rusty lanterns.", "three rusty lanterns", "past"),
        ("we are flying to the island with two accordions", "two accordions", "plan"),
        ("it rained, and the parrot stole half my sandwich", "half your sandwich", "past"),
        ("onto a garden gnome", "a garden gnome", "now"),
    ],
)
def test_the_phrase_that_carries_most_information_is_the_highlight(text: str, highlight: str, tense: str) -> None:
    found = taken(text)
    assert found is not None
    assert highlight in found.highlight
    assert found.told.tense == tense


def test_a_phrase_from_the_previous_utterance_is_not_the_highlight_again() -> None:
    first = taken("there is a badger in the greenhouse")
    again = taken("the badger ate my marrows", "there is a badger in the greenhouse")
    assert first is not None and "badger" in first.highlight
    assert again is not None and "badger" not in again.highlight


@pytest.mark.parametrize("text", ["I don't have a parrot", "if I had a trombone", "we could buy a canoe"])
def test_a_denied_or_imagined_thing_is_not_a_highlight(text: str) -> None:
    found = taken(text)
    assert found is None or not found.highlight


@pytest.mark.parametrize("text", ["my cousin Rosalind", "I met Rosalind", "bye robot"])
def test_a_persons_name_alone_is_not_a_highlight(text: str) -> None:
    found = taken(text)
    assert found is None or found.highlight.lower() != "rosalind"
    assert found is None or "robot" not in found.highlight.lower()


@pytest.mark.parametrize("text", ["yes", "hm", "why not?", "Is there a badger in the greenhouse?"])
def test_answers_and_questions_are_not_taken_up(text: str) -> None:
    assert taken(text) is None


@pytest.mark.parametrize("mood", MOODS)
@pytest.mark.parametrize("person", PERSONS)
@pytest.mark.parametrize("tense", TENSES)
def test_taking_up_yaml_has_replies_for_each_person_tense_and_mood(person: str, tense: str, mood: str) -> None:
    told = Taken(Told("the roof leaks", person, tense), "the roof")
    groups = list(replies(told, material().taking_up, mood, State(), random.Random(0)))
    assert sum(len(lines) for group in groups for lines in group) >= 2
