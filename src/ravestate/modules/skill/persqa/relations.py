"""The table `relations.yaml`: the topics of predicates and nouns."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from typing import Any, cast

from ravestate.yaml_text import load_yaml

from .topics import RELATIVES


@dataclass(frozen=True, slots=True)
class Relations:
    """The table `relations.yaml`; each part maps the words there to their topic."""

    says: Mapping[str, str]
    ends: Mapping[str, str]
    asks: Mapping[str, str]
    nouns: Mapping[str, str]
    """Nouns of topics, and of people and animals: *my job*, *my sister*."""
    words: Mapping[str, frozenset[str]]
    """The other lists."""


@cache
def relations() -> Relations:
    """Return the table."""
    file = files(__name__.rpartition(".")[0]) / "relations.yaml"
    table: dict[str, Any] = load_yaml(file.read_text(encoding="utf-8"), str(file))

    def turned(name: str) -> dict[str, str]:
        return {phrase: topic for topic, phrases in table[name].items() for phrase in phrases}

    relatives = {noun: topic.name for topic in RELATIVES for noun in topic.nouns}
    lists = {name: frozenset(cast("list[str]", words)) for name, words in table.items() if isinstance(words, list)}
    return Relations(turned("says"), turned("ends"), turned("asks"), {**turned("nouns"), **relatives}, lists)
