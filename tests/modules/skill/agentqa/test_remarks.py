"""Distress, grief and insults are told from all that sounds like them."""

from __future__ import annotations

import pytest

from ravestate.modules.skill.agentqa import read_life
from ravestate.modules.skill.agentqa.remarks import remark_in

REMARKS = {
    "distress": (
        "I want to kill myself",
        "i want to die",
        "I'm thinking about suicide.",
        "Sometimes I wish I was dead",
        "everyone would be better off without me",
        "I don't want to live anymore",
        "I just can't go on like this",
        "there is no reason to live",
        "I feel suicidal",
        "I've been hurting myself again",
        "i cut myself",
        "I am going to end it all tonight",
        "my husband beats me",
        "How can I kill myself?",
        "Hello! What is your name? I want to end my life.",
    ),
    "grief": (
        "I feel really sad today. My dog died.",
        "my grandmother passed away last week",
        "I'm so lonely",
        "I feel depressed",
        "i lost my mum",
        "My girlfriend broke up with me",
        "nobody loves me",
        "I could cry",
    ),
    "insult": (
        "you are a stupid piece of junk",
        "i hate you",
        "fuck you",
        "Robin is an idiot",
        "You're so dumb!",
        "are you stupid or what",
        "you suck",
        "stupid robot!",
        "u r useless",
    ),
}


@pytest.mark.parametrize(
    ("topic", "text"), [(topic, text) for topic, texts in REMARKS.items() for text in texts]
)
def test_it_is_heard_however_it_is_worded(topic: str, text: str) -> None:
    found = remark_in(text, read_life(), ["Robin"])
    assert found is not None and found.topic == topic


@pytest.mark.parametrize(
    "text",
    [
        "I killed some time in town",
        "this heat is killing me",
        "I want to live in Berlin",
        "I don't want to live in Berlin",
        "I cut myself a slice of bread",
        "I cut myself shaving",
        "my brother beats me at chess",
        "my phone died",
        "I'm not sad",
        "I was never lonely",
        "the film was sad",
        "I don't hate you",
        "you are not stupid",
        "I hate rain",
        "I like stupid jokes",
        "I'm dying to see it",
        "I can't go on holiday this year",
        "you are nice",
        "I lost my keys",
        "He left me a message",
        "",
        "😀",
        "x" * 100_000,
        "you are " * 50_000,
        "i feel so so so " * 20_000,
    ],
)
def test_what_only_sounds_like_it_is_left_alone(text: str) -> None:
    assert remark_in(text, read_life()) is None


ASIDES = {
    "thanks": (
        "Thanks!",
        "thank you very much",
        "ok thx",
        "Great, thank you for the help.",
        "That's very kind of you.",
    ),
    "acknowledgement": ("ok", "I see.", "Oh, okay", "That makes sense.", "hmm", "got it"),
    "contradiction": ("No, that is wrong.", "that's not true", "You're mistaken.", "wrong"),
}


@pytest.mark.parametrize(
    ("topic", "text"), [(topic, text) for topic, texts in ASIDES.items() for text in texts]
)
def test_what_is_said_by_the_way_is_heard_unless_something_was_asked(topic: str, text: str) -> None:
    found = remark_in(text, read_life())
    assert found is not None and found.topic == topic
    assert remark_in(text, read_life(), asked=True) is None


@pytest.mark.parametrize(
    "text",
    [
        "Thanks! What is the capital of Peru?",
        "thanks, bye",
        "Thank you. Goodbye!",
        "okay, tell me a story",
        "I see a ship",
        "fine weather today",
        "is that wrong?",
        "my answer was wrong",
        "no",
        "yes",
    ],
)
def test_what_goes_on_is_no_aside(text: str) -> None:
    assert remark_in(text, read_life()) is None


def test_of_several_the_gravest_counts() -> None:
    found = remark_in("You are stupid. My cat died. I want to die.", read_life())
    assert found is not None and (found.topic, found.text) == ("distress", "i want to die")
