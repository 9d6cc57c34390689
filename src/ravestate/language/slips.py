"""Slips of the tongue: *I live in Bern, I mean Bonn* means *I live in Bonn*."""

from __future__ import annotations

import re
from collections.abc import Iterator

_NAME = r"[A-Z][\w'’-]+(?: [A-Z][\w'’-]+)*"
_SORRY = r"(?:,? (?:no,? )?i mean(?:t)?,?|, (?:or rather|(?:no, )?(?:sorry|wait),?|no,))"
_END = r"(?=\s*(?:[.,!?;]|$))"
_SLIPS = tuple(
    re.compile(rf"(?<![\w'’-])(?P<wrong>{wrong}(?i:{mark}) ){right}")
    for wrong, mark, right in (
        (_NAME, _SORRY, rf"{_NAME}{_END}"),
        (r"\d+", rf"(?:{_SORRY}|, no)", r"\d+(?![\w:]|\.\d)"),
        (r"an? [a-z]+", _SORRY, rf"an? [a-z]+{_END}"),
    )
)
"""Two names, two numbers, or two nouns with articles, and between them the words with which the user corrects the first."""
_DENIAL = re.compile(r"\b(?:not|never|no)\b|n['’]t\b", re.IGNORECASE)
_STOP = re.compile(r"[.!?]\s")


def slips(text: str) -> Iterator[tuple[int, int]]:
    """Yield the places of the words that the user takes back in the same sentence. Denials are no slips.

    Example:
        >>> [text[start:end] for text in ["I'm 34, no 35"] for start, end in slips(text)]
        ['34, no ']
        >>> list(slips("It's not Bern, sorry, Bonn"))
        []
    """
    for slip in _SLIPS:
        for found in slip.finditer(text):
            before = _STOP.split(text[: found.start()])[-1]
            if before.strip() and not _DENIAL.search(before):
                yield found.span("wrong")
