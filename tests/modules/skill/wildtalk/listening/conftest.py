"""A conversation with the listening skill alone."""

from __future__ import annotations

import random
from collections.abc import Callable

import pytest

from ravestate.language.matcher import bundled_matcher
from ravestate.language.network import network
from ravestate.modules.meta.nlp.analysis import Analysis, analyse
from ravestate.modules.meta.nlp.pipeline import pipeline
from ravestate.modules.skill.wildtalk.listening import Heard, Listener, State
from ravestate.modules.skill.wildtalk.listening.phrases import Line, Phrases


class Talk:
    """A conversation of a user with the skill, with its state."""

    def __init__(self, seed: int = 0) -> None:
        self.listener = Listener()
        self.state = State()
        self._chance = random.Random(seed)

    def say(self, text: str, *, parsed: bool = True) -> str:
        """Return the answer to an utterance."""
        answer = self.listener.answer(Heard(text, seen(text) if parsed else None), self.state, self._chance)
        self.state = answer.state
        return answer.text


def seen(text: str) -> Analysis:
    """Return the analysis of a text."""
    return analyse(text, pipeline(""), ("Ravestate",))


@pytest.fixture(scope="session", autouse=True)
def _models() -> None:
    for name in ("acts", "feelings", "asks"):
        bundled_matcher(name).load()
    network().load()
    Listener().load()


@pytest.fixture
def begin() -> Callable[[int], Talk]:
    """Return a function that begins a conversation with a seed."""
    return Talk


@pytest.fixture
def talk() -> Talk:
    """A talk."""
    return Talk()


def lines_of(phrases: Phrases) -> list[Line]:
    return [line for lines in phrases.groups.values() for line in lines]
