"""Patterns for sentences: one regular expression per line, with two signs added.

``…`` stands for the wanted words. ``~`` at the end of a line stands for the end of the sentence, with or without
small words such as *again*. White space at both ends of a line does not count.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping

Patterns = tuple[tuple[str, re.Pattern[str]], ...]
"""Names and their expressions."""

_END = (
    r"( (again|now|then|actually|exactly|at the moment|currently|for a living|in my (free|spare) time|called|please|"
    r"from|anyway))*\W*$"
)


def patterns(lines: Mapping[str, str]) -> Patterns:
    """Compile the lines under each name, in their order.

    Example:
        >>> [(name, pattern)] = patterns({"home": "i live in …"})
        >>> name, wanted(pattern.search("Now I live in Ulm"))
        ('home', 'Ulm')
    """
    return tuple(
        (name, re.compile(rf"(?<![\w'])(?:{line})", re.IGNORECASE))
        for name, text in lines.items()
        for line in _lines(text)
    )


def either(text: str) -> str:
    """Return one expression that matches any of the lines.

    Example:
        >>> either('''
        ...     no comment
        ...     next question
        ... ''')
        '(?:no comment|next question)'
    """
    return f"(?:{'|'.join(_lines(text))})"


def wanted(match: re.Match[str] | None) -> str:
    """Return the words at the ``…``; an empty string if the pattern has none, or did not match."""
    return "" if match is None else match.groupdict().get("wanted") or ""


def _lines(text: str) -> Iterator[str]:
    for line in text.strip().splitlines():
        line = line.strip()
        if line:
            line = line.replace("…", "(?P<wanted>.+)", 1)
            yield line[:-1] + _END if line.endswith("~") else line
