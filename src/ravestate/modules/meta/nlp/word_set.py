"""Sets of words, written as they are read."""

from __future__ import annotations

__all__ = ["word_set"]


def word_set(*texts: str) -> frozenset[str]:
    """Return the words of `texts`, which white space separates.

    Example:
        >>> sorted(word_set("here there", "home"))
        ['here', 'home', 'there']
    """
    return frozenset(word for text in texts for word in text.split())
