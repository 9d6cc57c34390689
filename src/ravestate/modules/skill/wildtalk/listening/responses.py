"""Find the replies that suit an utterance: *you can be proud of that*, *what a shame*...

Similar words may need opposite replies: *my cat sleeps upside down* is funny, *my goldfish swims upside down* is sad. A small network (``responses.onnx``)
grades each reply of responses.yaml. It has learnt from the grades that readers gave to such replies.
``tools/networks`` has these grades.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from math import log
from pathlib import Path

from ravestate.language.network import Network

from .material import PREFIX, Material
from .moment import Line, Moment

LEAST = 1.35
"""The minimum grade at which a reply is said. Below, a sign of listening is better."""
SURE = 1.4
"""The minimum grade at which a reply may take precedence over the bank. See the tag `responsive` in hearing.py."""
GENERAL = frozenset(("asks_fact", "asks_feeling", "asks_advice", "asks_favour", "tells_on", "answers", "nonsense"))
"""Kinds of reply that say little. They never take precedence over the bank."""
KIND = 0.3
"""A reply's rank is its grade plus this weight times the logarithm of the probability of its kind."""
LIGHT = ("glad", "funny")
"""The tones of cheerful and funny replies."""
LONGEST = 300
"""The maximum number of characters that the network reads."""
REMEMBERED = 8
"""The number of texts whose grades are kept, because modules may ask for a text again. A text takes 200 kB."""


@dataclass(frozen=True, slots=True)
class Response:
    """A reply, and how well it suits."""

    grade: float
    """0: it does not suit; 1: it does no harm; 2: it is good."""
    rank: float
    """The grade, lowered for an improbable kind. A kind is judged more reliably than a single reply."""
    kind: Moment
    line: Line


class Grader(Network):
    """A small recurrent network that grades replies to a text. Thread-safe."""

    def __init__(self, file: Path) -> None:
        """Choose a trained network; load nothing yet."""
        super().__init__(file)
        self._latest = lru_cache(REMEMBERED)(self._graded)

    def grades(self, text: str, before: str = "") -> Mapping[str, tuple[float, float]]:
        """Return for each reply its expected grade, 0 to 2, and the probability of its kind.

        There are none before `load`, or for a blank text.

        Args:
            text: The utterance in normal form.
            before: The user's previous utterance in normal form; empty if there is none.
        """
        text, before = text[:LONGEST], before[:LONGEST]  # long texts would fill the cache
        return self._latest(text, before) if self.loaded and text.strip() else {}

    def _graded(self, text: str, before: str) -> Mapping[str, tuple[float, float]]:
        _, found = self.run(text, before=before)
        return dict(zip(self.labels, zip(*(one[0].tolist() for one in found), strict=True), strict=True))


_NETWORK = Grader(Path(__file__).with_name("responses.onnx"))


def responses_to(phrases: Material, text: str, before: str = "", *, dark: bool) -> list[Response]:
    """Return the replies that suit an utterance, the best first.

    A reply that the network does not know gets the mean grade of its kind. A kind of which the network knows no reply
    is left out. Before the network is loaded, there are no replies.

    Args:
        phrases: The replies.
        text: The utterance in normal form.
        before: The user's previous utterance in normal form; empty if there is none.
        dark: Whether the utterance or the conversation is sad or grave. If so, there are no cheerful or funny replies.
    """
    grades = network().grades(text, before)
    found: list[Response] = []
    for kind in phrases.responses.values():
        lines = [line for group in kind.groups.values() for line in group]
        known = [grades[line.text] for line in lines if line.text in grades]
        if not known or (dark and kind.tone in LIGHT):
            continue
        mean = sum(grade for grade, _ in known) / len(known)
        likely = KIND * log(max(known[0][1], 1e-9))
        for line in lines:
            grade = grades[line.text][0] if line.text in grades else mean
            found.append(Response(grade, grade + likely, kind, line))
    return sorted((one for one in found if one.grade >= LEAST), key=lambda one: -one.rank)


def surely_suits(found: list[Response], least: float = SURE) -> bool:
    """Return whether the best reply takes precedence over the bank.

    Its grade must be at least `least`, and its kind must not be general.
    """
    return bool(found) and found[0].grade >= least and not is_general(found[0].kind)


def is_general(kind: Moment) -> bool:
    """Return whether the replies of a kind say little."""
    return kind.name.removeprefix(PREFIX) in GENERAL


def network() -> Grader:
    """Return the network, which all contexts share. It may not be loaded yet."""
    return _NETWORK
