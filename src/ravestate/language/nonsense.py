"""Recognise texts that come from hitting the keyboard at random."""

from __future__ import annotations

import re

_WORD = re.compile(r"[^\W\d_]+")
_MASHED = re.compile(
    r"(.)\1{3}|[^aeiouyäöüáéíóúàèêâ]{6}|(?:qwe|wer|asd|sdf|dfg|fgh|ghj|hjk|jkl|zxc|xcv|cvb|yxc)\w*", re.IGNORECASE
)
_NO_VOWEL = re.compile(r"[^aeiouy]{4,}")


def is_nonsense(text: str) -> bool:
    """Return whether a text looks as if the keyboard was hit at random.

    Example:
        >>> is_nonsense("asdfgh jkl"), is_nonsense("hello there")
        (True, False)
    """
    words = _WORD.findall(text)
    letters = sum(map(len, words))
    mashed = [word for word in words if len(word) > 3 and (_MASHED.search(word) or _NO_VOWEL.fullmatch(word.lower()))]
    return bool(words) and sum(map(len, mashed)) > letters / 2
