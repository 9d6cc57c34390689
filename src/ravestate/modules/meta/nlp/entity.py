"""Something that is named in a text."""

from __future__ import annotations

from dataclasses import dataclass

__all__ = ["Entity"]


@dataclass(frozen=True, slots=True)
class Entity:
    """A name, a date, a number."""

    text: str
    """As written."""
    label: str
    """What it is, in the pipeline's scheme: ``PERSON``, ``GPE`` (a country, a town), ``DATE``, ``CARDINAL``..."""
    start: int
    """Where it begins, in characters of the text."""
    end: int
    """Where it ends, in characters of the text: ``text[start:end]``."""
