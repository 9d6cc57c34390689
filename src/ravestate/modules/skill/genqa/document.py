"""Documents, and the passages of documents."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Passage:
    """One or two sentences that can be an answer."""

    text: str
    hints: str = ""
    """Further words that a question may use for the passage. The search uses them, and no answer shows them."""


@dataclass(frozen=True, slots=True)
class Document:
    """A part of a file. The part has one subject."""

    title: str
    """The subject, which gives each passage its context."""
    source: str
    """The source that an answer names."""
    passages: Iterable[Passage]
    """The passages. They may come from a generator, so that a large file is never in memory as a whole."""
