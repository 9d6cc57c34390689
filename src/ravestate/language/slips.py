"""Slips of the tongue: *I live in Bern, I mean Bonn* means *I live in Bonn*."""

from __future__ import annotations

import re
from collections.abc import Iterator

_NAME = r"[A-Z][\w'’-]+(?: [A-Z][\w'’-]+)*"
_NUMBER = r"\d+(?:[.,:]\d+)*(?![.,:]?\d)"
"""A whole number, price or time: *3.50*, *1,000*, *9:30*."""
_NO = r"(?:, no, (?:i mean(?:t)?|sorry|wait),?|, no,)"
_SORRY = rf"(?:, (?:no )?i mean(?:t)?,?|, (?:or rather|(?:sorry|wait),?)|{_NO})"
_END = r"(?=\s*(?:[.,!?;]|$))"
_CLOSED = r"(?=\s*(?:[.,!?;]|$)|,? I (?:think|guess|believe)\b)"
_NOBODY = r"(?!(?:Mum|Mom|Mummy|Mommy|Dad|Daddy|Gran|Grandma|Grandpa|Granny|Sir|Madam|Doctor|Professor)\b)"
"""Excludes words with which the user addresses the listener: *I came from Bern, sorry, Mum* corrects nothing."""
_SLIPS = tuple(
    re.compile(rf"(?<![\w'’-])(?<!\d[.,:])(?P<wrong>{wrong}(?i:{mark}) ){right}")
    for wrong, mark, right in (
        (_NAME, _SORRY, rf"{_NOBODY}{_NAME}{_END}"),
        (_NUMBER, rf"(?:{_SORRY}|, no)", rf"{_NUMBER}{_CLOSED}"),
        (_NUMBER, _NO, rf"{_NUMBER}(?!\w)"),
        (rf"{_NUMBER} (?P<unit>[a-z]+)", rf"(?:{_SORRY}|, no)", rf"{_NUMBER} (?P=unit){_CLOSED}"),
        (r"an? [a-z]+", _SORRY, rf"an? [a-z]+{_END}"),
    )
)
"""Two names, two numbers, or two nouns with articles, and between them the words with which the user corrects the first.

Other words may follow the second number only if the correction contains *no* with a comma: *There were 10, no, 12
people*. *There were 10, no 2 alike* corrects nothing.
"""
_DENIAL = re.compile(r"\b(?:not|never|no)\b|n['’]t\b", re.IGNORECASE)
_STOP = re.compile(r"[.!?]\s")


def slips(text: str) -> Iterator[tuple[int, int]]:
    """Yield the places of the words that the user takes back in the same sentence.

    After a denial (*not*, *never*, *no*) in the sentence, nothing counts as taken back.

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
