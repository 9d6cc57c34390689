"""The normal form of a text: typed English as written English, with offsets into the original."""

from __future__ import annotations

import re
from collections.abc import Collection
from dataclasses import dataclass

from .contractions import WRITTEN


@dataclass(frozen=True, slots=True)
class Normal:
    """A text in its normal form."""

    text: str
    """The normal form: short forms written out, typing errors mended, names and *I* in capitals, a mark at the end."""
    original: str
    """The text as typed."""
    origin: tuple[int, ...]
    """For each character of `text`, and for its end, the position in `original`. It never decreases."""

    def span(self, start: int, end: int) -> tuple[int, int]:
        """Return the span of `original` that ``text[start:end]`` stands for."""
        return self.origin[start], self.origin[end]


_WORD = re.compile(r"[^\W_]+(?:['’-][^\W_]+)*")


def normalise(text: str, names: Collection[str] = ()) -> Normal:
    """Return the normal form of `text`.

    Args:
        text: The text as typed.
        names: Names that keep or get their capitals, such as the agent's and the user's.

    Example:
        >>> normalise("u cant do that, can u?").text
        'you can not do that, can you?'
    """
    known = {name.lower(): name for name in names}
    parts: list[str] = []
    origin: list[int] = []
    last = 0
    for found in _WORD.finditer(text):
        parts.append(text[last : found.start()])
        origin += range(last, found.start())
        word = found[0].replace("’", "'")
        written = known.get(word.lower()) or WRITTEN.get(word.lower(), word)
        if written != word and word[0].isupper():
            written = written[0].upper() + written[1:]
        parts.append(written)
        size, wide = len(found[0]), len(written)
        origin += (found.start() + min(size * place // wide, size) for place in range(wide))
        last = found.end()
    parts.append(text[last:])
    origin += range(last, len(text) + 1)
    return Normal("".join(parts), text, tuple(origin))


def plain(text: str) -> str:
    """Return the words of a text in lower case, without punctuation, short forms written out: a form to compare.

    Example:
        >>> plain("What's up, Doc?")
        'what is up doc'
    """
    words: list[str] = [found[0].replace("’", "'").lower() for found in _WORD.finditer(text)]
    return " ".join(WRITTEN.get(word, word) for word in words).lower()
