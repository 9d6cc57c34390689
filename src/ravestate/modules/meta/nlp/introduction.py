"""An introduction within a longer utterance: *my name is Ada. I have had a long day*."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

SHORTEST = 3
"""The minimum number of words that say more than the name."""

_NAMED = re.compile(
    r"^\W*(?:(?:hi|hello|hey|oh|and|well|so|by the way|btw|good (?:morning|evening|day)|nice to meet you)\b\W*)*"
    r"(?:my name(?: is|'s)|you (?:can|may) call me|call me|i am called|i am|i'm|this is)\s+"
    r"([^\W\d_][\w'’-]*)(?:\s*(?:,|\band\b|\bbut\b|by the way|btw)+\s*(.*)|\W*)$",
    re.IGNORECASE,
)
_POLITE = re.compile(
    r"\W*(?:hi|hello|hey|good (?:morning|evening|day|afternoon)|(?:nice|pleased|glad) to meet you|there|you too)\W*",
    re.IGNORECASE,
)
"""A part that is only polite."""
_SURELY = re.compile(r"\b(?:my name|call me|called)\b", re.IGNORECASE)


@dataclass(frozen=True, slots=True)
class Introduction:
    """The name that an utterance tells, and its other words."""

    name: str
    rest: str


def introduction_in(sentences: Sequence[str], names: Sequence[str]) -> Introduction | None:
    """Return the introduction in an utterance that also says more; None if there is none.

    Args:
        sentences: The sentences of the utterance.
        names: The names of persons in it. After *I am*, only such a word is a name.

    Example:
        >>> introduction_in(["I'm Ada.", "We moved here in May."], ["Ada"])
        Introduction(name='Ada', rest='We moved here in May.')
    """
    for place, sentence in enumerate(sentences):
        found = _NAMED.match(sentence)
        if found is None or not (_SURELY.search(sentence) or found[1].lower() in map(str.lower, names)):
            continue
        parts = (*sentences[:place], found[2] or "", *sentences[place + 1 :])
        rest = " ".join(part for part in parts if part and not _POLITE.fullmatch(part))
        if len(re.findall(r"\w+", rest)) >= SHORTEST:
            return Introduction(found[1][:1].upper() + found[1][1:], rest)
    return None
