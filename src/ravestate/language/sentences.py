"""Split a text into sentences."""

from __future__ import annotations

import re

_SENTENCE = re.compile(r"[^.!?…\n]+(?:[.](?=\w)[^.!?…\n]+)*[.!?…]*")
"""A dot inside a word or a number ends no sentence."""


def sentences(text: str) -> tuple[str, ...]:
    """Return the sentences of a text, with their punctuation; parts without a letter or digit are left out.

    Example:
        >>> sentences("Hi! How are you? I paid 3.50 today.")
        ('Hi!', 'How are you?', 'I paid 3.50 today.')
    """
    found = (sentence.strip() for sentence in _SENTENCE.findall(text))
    return tuple(sentence for sentence in found if any(letter.isalnum() for letter in sentence))
