"""A named entity of a text."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Entity:
    """A name, a date or a number in a text."""

    text: str
    """The text of the entity, as written."""
    label: str
    """Its label in the pipeline's scheme: ``PERSON``, ``GPE`` (a country, a town), ``DATE``, ``CARDINAL``..."""
    start: int
    """The position of its first character in the text."""
    end: int
    """The position after its last character: ``text[start:end]`` is the entity."""
