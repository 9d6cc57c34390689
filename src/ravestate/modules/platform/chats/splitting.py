"""A function that splits a long text into messages."""

from __future__ import annotations

import re

ENDS = (re.compile(r"\n\n"), re.compile(r"\n"), re.compile(r"(?<=[.!?…]) "), re.compile(r" "))
"""The places at which a text may be split, the best first."""


def split(text: str, longest: int, *, first: int | None = None) -> list[str]:
    """Split a text into parts of at most `longest` characters, if possible between paragraphs, lines, sentences or words.

    If `first` is given, the first part has at most `first` characters.

    Example:
        >>> split("One two. Three four.", 12)
        ['One two.', 'Three four.']
    """
    parts: list[str] = []
    limit = first or longest
    while len(text) > limit:
        start = text[: limit + 1]
        cut = next(
            (found[-1] for end in ENDS if (found := [m.end() for m in end.finditer(start) if m.end() > limit // 2])),
            limit,
        )
        parts.append(text[:cut].strip())
        text, limit = text[cut:], longest
    return [part for part in (*parts, text.strip()) if part]
