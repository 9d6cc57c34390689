"""Cut running text into passages: single sentences, and sentences together with the sentence that they refer to."""

from __future__ import annotations

import re
from collections.abc import Iterator

from ravestate.modules._text import printable

from .document import Passage

LONGEST = 280
"""The usual maximum number of characters in a passage. If a sentence is more than `SHORTEST` longer, it is cut."""
SHORTEST = 12
"""The minimum number of characters in a passage; page numbers and captions are shorter."""

_PARAGRAPH = re.compile(r"\n\s*\n")
_END = re.compile(r"(?<=[.!?…])[\"”’)\]]*\s+(?=[\"“‘(\[]?([^\W_]))|(?<=[。！？])")
_ABBREVIATION = re.compile(
    r"(?:\b(?:Mr|Mrs|Ms|Dr|Prof|St|vs|No|Fig|Vol|pp?|ca|approx|e\.g|i\.e|cf|etc|al|Jan|Feb|Mar|Apr|Jun|Jul|Aug|Sep|"
    r"Sept|Oct|Nov|Dec|Inc|Ltd|Co|U\.S|U\.K)|\s\d{1,2})\.\s*\Z"
)
_INITIAL = re.compile(r"\b([^\W\d_])\.\s*\Z")
# First words of a sentence that refers to an earlier sentence.
_LEANS = re.compile(r"(?:It|Its|He|She|His|Her|They|Their|This|These|That|Those|There|Here|Such)\b")
_HYPHEN = re.compile(r"(?<=([^\W\d_]))-\n(?=([^\W\d_]))")


def passages_of(text: str) -> Iterator[Passage]:
    """Yield the passages of `text`, in order.

    An empty line ends a paragraph; a single line break is a space. A sentence that begins with a word such as *it* or
    *this* refers to the latest sentence of its paragraph without such a beginning. If both together are short enough, they
    are one passage.

    Example:
        >>> [p.text for p in passages_of("Delft is a town in Holland. It has 100,000 inhabitants.\\n\\nVermeer lived there.")]
        ['Delft is a town in Holland.', 'Delft is a town in Holland. It has 100,000 inhabitants.', 'Vermeer lived there.']
    """
    for paragraph in _PARAGRAPH.split(_HYPHEN.sub(_unbroken, printable(text))):
        before = ""
        for sentence in _sentences(" ".join(paragraph.split())):
            if before and _LEANS.match(sentence) and len(before) + len(sentence) < LONGEST:
                yield Passage(f"{before} {sentence}")
                continue
            before = sentence
            if len(sentence) >= SHORTEST:
                yield Passage(sentence)


def _sentences(paragraph: str) -> Iterator[str]:
    start = 0
    for end in _END.finditer(paragraph):
        if not (end[1] or "").islower() and not _is_abbreviated(paragraph[max(start, end.start() - 12) : end.start()]):
            yield from _fitting(paragraph, start, end.end())
            start = end.end()
    yield from _fitting(paragraph, start, len(paragraph))


def _is_abbreviated(text: str) -> bool:
    """Return whether a text ends with an abbreviation or with the initial of a name."""
    initial = _INITIAL.search(text)
    return bool(_ABBREVIATION.search(text) or (initial and initial[1].isupper()))


def _unbroken(hyphen: re.Match[str]) -> str:
    """Return the text that replaces a hyphen at the end of a line: nothing between two small letters."""
    return "" if hyphen[1].islower() and hyphen[2].islower() else hyphen[0]


def _fitting(paragraph: str, start: int, end: int) -> Iterator[str]:
    """Yield the sentence from `start` to `end` in short parts. Yield nothing if the sentence has no letter."""
    while end - start > LONGEST + SHORTEST:  # a cut must leave a rest that is long enough
        window = paragraph[start : start + LONGEST]
        cut = max(window.rfind(mark, LONGEST // 3) for mark in ("; ", ": ", ", ")) + 1
        cut = cut or window.rfind(" ", LONGEST // 3) + 1 or LONGEST
        yield window[:cut].strip()
        start += cut
    sentence = paragraph[start:end].strip()
    if any(character.isalpha() for character in sentence):
        yield sentence
