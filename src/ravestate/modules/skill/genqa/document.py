"""What is kept of a text: documents, and passages that can be answers."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

__all__ = ["Document", "Passage"]


@dataclass(frozen=True, slots=True)
class Passage:
    """A sentence or two."""

    text: str
    hints: str = ""
    """Further words that a question may use for what it says: they are searched, and never shown."""


@dataclass(frozen=True, slots=True)
class Document:
    """A part of a file that is about one thing."""

    title: str
    """What it is about: each passage is understood under it."""
    source: str
    """Where an answer says that it is from."""
    passages: Iterable[Passage]
    """May be a generator: a large file is never held in memory."""
