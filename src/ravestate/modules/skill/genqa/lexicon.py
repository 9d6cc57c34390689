"""Lists of words from YAML files, and the variants of words that count as the same word."""

from __future__ import annotations

from functools import cache
from importlib.resources import files
from typing import Any

from ravestate.yaml_text import load_yaml


@cache
def lexicon(name: str = "words.yaml") -> dict[str, Any]:
    """Return the content of a YAML file in this folder."""
    return load_yaml((files(__package__ or "") / name).read_text(encoding="utf-8"), name)


@cache
def words_of(name: str) -> frozenset[str]:
    """Return a list of ``words.yaml`` as a set."""
    return frozenset(str(lexicon()[name]).split())


@cache
def _variants() -> dict[str, tuple[str, ...]]:
    found: dict[str, tuple[str, ...]] = {}
    for group in str(lexicon()["same"]).replace("\n", "|").split("|"):
        for word in group.split():
            found[word] = tuple(dict.fromkeys((*found.get(word, (word,)), *group.split())))
    return found


def variants_of(word: str) -> tuple[str, ...]:
    """Return the word itself and its variants.

    Example:
        >>> variants_of("wrote"), variants_of("Peru")
        (('wrote', 'write', 'written', 'author'), ('Peru',))
    """
    return _variants().get(word.lower(), (word,))
