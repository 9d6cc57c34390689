"""Documents, and passages that can be answers."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Passage:
    """A sentence or two."""

    text: str
    hints: str = ""
    """Further words that a question may use for it. The search uses them; they never appear."""


@dataclass(frozen=True, slots=True)
class Document:
    """A part of a file about one subject."""

    title: str
    """The subject, which gives each passage its context."""
    source: str
    """The source that an answer names."""
    passages: Iterable[Passage]
    """The passages, possibly from a generator: a large file is never in memory as a whole."""
