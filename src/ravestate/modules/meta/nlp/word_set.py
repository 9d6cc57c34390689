"""Sets of words from plain text."""

from __future__ import annotations


def word_set(*texts: str) -> frozenset[str]:
    """Return the words of `texts`, separated by white space.

    Example:
        >>> sorted(word_set("here there", "home"))
        ['here', 'home', 'there']
    """
    return frozenset(word for text in texts for word in text.split())
