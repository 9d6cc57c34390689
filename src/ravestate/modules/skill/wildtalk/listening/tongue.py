"""Utterances without English words: other languages, and numbers."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Mapping

_WORD = re.compile(r"[^\W\d_]+")


def tongue_of(text: str, tongues: Mapping[str, frozenset[str]]) -> str:
    """Return the language of a text: a key of `tongues`, ``?`` for another script, or empty for English and anything else.

    Example:
        >>> tongue_of("ich bin heute müde", {"de": frozenset(("ich", "bin", "heute"))})
        'de'
    """
    words = [word.lower() for word in _WORD.findall(text)]
    if not words:
        return ""
    foreign = sum(not unicodedata.name(letter, "LATIN").startswith("LATIN") for word in words for letter in word)
    if foreign > sum(map(len, words)) / 2:
        return "?"
    counts = {name: sum(word in known for word in words) for name, known in tongues.items()}
    best = max(counts, key=lambda name: counts[name], default="")
    needed = 1 if len(words) == 1 and len(words[0]) > 3 else max(2, 0.5 * len(words))
    return best if best and counts[best] >= needed else ""


def is_number(text: str) -> bool:
    """Return whether a text has digits and no letters."""
    return any(map(str.isdigit, text)) and not any(map(str.isalpha, text))
