"""Find the replies that suit an utterance: *you can be proud of that*, *what a shame*...

Similar words may need opposite replies: *my cat sleeps upside down* is funny, *my goldfish swims upside down* is sad. A network
(``language/replies.py``) grades each reply of responses.yaml.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass
from math import log

from ravestate.language.replies import replies

from .material import Material
from .phrases import Line, Phrases

FITTING, KNOWN = 1.2, 1.6
"""`FITTING`: the minimum grade of a reply that fits. `KNOWN`: the minimum grade of a reply that surely suits. Readers called
70 % of such replies good, and 9 % bad."""
GENERAL = frozenset(("asks_fact", "asks_feeling", "asks_advice", "asks_favour", "tells_on", "answers", "nonsense"))
"""Kinds of reply that say little."""
KIND = 0.3
"""A reply's rank is its grade plus this weight times the logarithm of the probability of its kind."""
LIGHT = ("glad", "funny")
"""The tones of cheerful and funny replies."""


@dataclass(frozen=True, slots=True)
class Response:
    """A reply, and how well it suits."""

    grade: float
    """0: it does not suit; 1: it does no harm; 2: it is good."""
    rank: float
    """The grade, lowered for an improbable kind. A kind is judged more reliably than a single reply."""
    kind: Phrases
    line: Line

    @property
    def sure(self) -> bool:
        """Whether the reply surely suits."""
        return self.grade >= KNOWN and not self.weak

    @property
    def weak(self) -> bool:
        """Whether the reply may fit only a little, or says little."""
        return self.grade < FITTING or self.kind.name in GENERAL


def responses_to(
    phrases: Material, text: str, before: str = "", said: str = "", *, without: Collection[str] = ()
) -> list[Response]:
    """Return the replies that suit an utterance, the best first.

    A reply that the network does not know gets the mean grade of its kind. A kind of which the network knows no reply
    is left out. Before the network is loaded, there are no replies.

    Args:
        phrases: The replies.
        text: The utterance in normal form.
        before: The user's previous utterance in normal form; empty if there is none.
        said: The agent's last answer; empty if there is none.
        without: The tones of the replies to leave out.
    """
    grades = replies().grades(text, before, said)
    found: list[Response] = []
    for kind in phrases.responses.values():
        lines = [line for group in kind.groups.values() for line in group]
        known = [grades[line.text] for line in lines if line.text in grades]
        if not known or kind.tone in without:
            continue
        mean = sum(grade for grade, _ in known) / len(known)
        likely = KIND * log(max(known[0][1], 1e-9))
        for line in lines:
            grade = grades[line.text][0] if line.text in grades else mean
            found.append(Response(grade, grade + likely, kind, line))
    return sorted(found, key=lambda one: -one.rank)
