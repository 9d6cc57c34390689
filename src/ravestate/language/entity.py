"""A named entity of a text."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Entity:
    """A name, a date, a number."""

    text: str
    """The text of the entity, as written."""
    label: str
    """Its label in the pipeline's scheme: ``PERSON``, ``GPE`` (a country, a town), ``DATE``, ``CARDINAL``..."""
    start: int
    """Its first position, in characters of the text."""
    end: int
    """The position after it, in characters of the text: ``text[start:end]``."""
