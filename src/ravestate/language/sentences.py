"""Split a text into sentences."""

from __future__ import annotations

import re

_ABBREVIATION = r"\b(?:mr|mrs|ms|dr|prof|st|mt|jr|vs|approx|no(?= ?\d)|[a-z](?:\.[a-z])+)\."
_SENTENCE = re.compile(rf"(?:{_ABBREVIATION}(?=\s+\w)|[^.!?…\n]|[.](?=\w))+[.!?…]*", re.IGNORECASE)
"""A sentence. A dot inside a word or a number, or after an abbreviation, does not end it."""


def sentences(text: str) -> tuple[str, ...]:
    """Return the sentences of a text with their punctuation. Leave out parts without a letter or digit.

    Example:
        >>> sentences("Hi! I am Dr. Sun. I paid 3.50 today.")
        ('Hi!', 'I am Dr. Sun.', 'I paid 3.50 today.')
    """
    found = (sentence.strip() for sentence in _SENTENCE.findall(text))
    return tuple(sentence for sentence in found if any(letter.isalnum() for letter in sentence))
