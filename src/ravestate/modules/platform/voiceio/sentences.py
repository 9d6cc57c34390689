"""Split a growing text into sentences, and remove the characters that a voice cannot speak."""

from __future__ import annotations

import re
from collections.abc import Iterator

# A Chinese or Japanese mark ends a sentence even if no space follows.
_END = re.compile(r"[.!?…]+[\"”’')\]]*(?=\s)|[。！？]+[\"”’'」』）)\]]*(?=[^。！？\"”’'」』）)\]])|\n+")
_ABBREVIATION = re.compile(r"\b(?:Mr|Mrs|Ms|Dr|Prof|St|vs|e\.g|i\.e|etc|[A-Z])\.$")
_UNSPEAKABLE = re.compile(
    "[\U0001f000-\U0001faff\u2600-\u27bf\u2b00-\u2bff\u2300-\u23ff\u200d\u20e3\ufe0e\ufe0f\U000e0020-\U000e007f*_`#]"
)
SHORTEST = 12
"""A sentence with fewer characters than this is spoken together with the next sentence, if there is one."""


def sentences(text: str, begin: int = 0, *, whole: bool) -> Iterator[tuple[int, str]]:
    """Yield the position and the text of each complete sentence from the character `begin` on.

    Args:
        text: The text so far.
        begin: The position where the first sentence begins.
        whole: Whether the text is complete. If so, its rest counts as a sentence, too.

    Example:
        >>> list(sentences("Once there was a robot. It li", whole=False))
        [(0, 'Once there was a robot.')]
    """
    for end in _END.finditer(text, begin):
        if end.end() - begin < SHORTEST or _ABBREVIATION.search(text[begin : end.end()]):
            continue
        yield begin, text[begin : end.end()]
        begin = end.end()
    if whole and text[begin:].strip():
        yield begin, text[begin:]


def speakable(text: str) -> str:
    """Return `text` with spaces in place of emoji and Markdown's marks, so that positions stay the same.

    If the text has no words, return an empty text.
    """
    plain = _UNSPEAKABLE.sub(lambda mark: " " * len(mark[0]), text)
    return plain if any(c.isalnum() for c in plain) else ""
