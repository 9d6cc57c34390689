"""A function that splits a long text into messages."""

from __future__ import annotations

import re

ENDS = (re.compile(r"\n\n"), re.compile(r"\n"), re.compile(r"(?<=[.!?…]) "), re.compile(r" "))
"""The places at which a text may be split, the best first."""


def split(text: str, longest: int) -> list[str]:
    """Split a text into parts of at most `longest` characters, if possible between paragraphs, sentences or words.

    Example:
        >>> split("One two. Three four.", 12)
        ['One two.', 'Three four.']
    """
    parts: list[str] = []
    while len(text) > longest:
        start = text[: longest + 1]
        cut = next(
            (found[-1] for end in ENDS if (found := [m.end() for m in end.finditer(start) if m.end() > longest // 2])),
            longest,
        )
        parts.append(text[:cut].strip())
        text = text[cut:]
    return [part for part in (*parts, text.strip()) if part]
