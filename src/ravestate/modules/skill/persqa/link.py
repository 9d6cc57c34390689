"""A link: a topic in a statement, and the phrase with its value."""

from __future__ import annotations

from dataclasses import dataclass

from ravestate.modules.meta.nlp.phrase import Phrase


@dataclass(frozen=True, slots=True)
class Link:
    """A topic in a statement, and the phrase with its value. The phrase is None if the statement gives no value."""

    topic: str
    phrase: Phrase | None = None
    sure: bool = True
    """Whether the words before the value can only introduce this topic: *my name is*."""
    value: str = ""
    """The value, if it differs from the phrase."""
