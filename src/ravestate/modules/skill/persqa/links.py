"""Links from statements to topics."""

from __future__ import annotations

from dataclasses import dataclass

from ravestate.modules import nlp
from ravestate.modules.meta.nlp.phrase import Phrase

from .topics import WORDS

NOW = frozenset(["tonight", "today", "tomorrow", "now", "this"])
"""Words for a time that makes a statement momentary."""


@dataclass(frozen=True, slots=True)
class Link:
    """A topic in a statement, and the phrase with its value. The phrase is None if the statement gives no value."""

    topic: str
    phrase: Phrase | None = None
    sure: bool = True
    """Whether the words before the value can only introduce this topic: *my name is*."""
    value: str = ""
    """The value, if it differs from the phrase."""


def predicate_of(said: nlp.Statement) -> str:
    """Return the predicate without *not*, and without verbs that only begin or continue it: *work for* of *start to work for*."""
    words = said.triple.predicate.removeprefix("not ").split()
    while len(words) > 1 and (words[0] in WORDS["beginning"] or words[:2] == ["end", "up"]):
        first = 2 if words[0] == "end" or words[1] == "to" else 1
        if len(words) == first:
            break  # "where did I end up"
        del words[:first]
        words[0] = said.verb if len(words) == 1 or words[0].endswith("ing") else words[0]
    return " ".join(words)
