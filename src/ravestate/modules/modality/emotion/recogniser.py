"""Recognise the feeling that fits an utterance: a compliment makes the agent shy, good news happy.

Patterns find expressions, and VADER rates words. Negations, conditions and most questions cancel both. A merely pleasant
statement ("the weather is nice") raises no feeling.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable

from .feeling import Feeling
from .patterns import (
    AFFECTION,
    AFFECTION_ASKED,
    DESPITE_NOT,
    IMAGINED,
    JOY,
    PRAISE,
    SORROW,
    SURPRISE,
    SURPRISE_ASKED,
)
from .praise import is_kind, is_praise
from .sentiment import polarity
from .utterance import LONGEST, Sentence, is_denied, sentences

DELIGHT = 0.5
"""The minimum polarity of a joyful exclamation or sentence about oneself."""

SAD = -0.5
"""The polarity that spoils joy: "I got my results, and I failed"."""

PICTURES: tuple[tuple[Feeling, re.Pattern[str]], ...] = (
    ("affectionate", re.compile("[❤💕💖💗💓💞💘💝💙💚💛💜🧡🤍🥰😍😘😚🤗🫂]|<3")),
    ("surprised", re.compile(r"[😮😲😯😱🤯😳]|(?<!\w)[:=]-?[oO]\b")),
    ("happy", re.compile(r"[😀😃😄😁😆🥳🎉🎊🤩]|(?<!\w):-?D\b")),
)

_CONDITION = re.compile(r"\b(?:if|unless|whether)\b")
_MINE = re.compile(r"\b(?:i|we|my|our|me|us)\b")
_THEIRS = re.compile(r"^(?:he|she|they|his|her|their|people|everyone|my|the|a|an)\b")
_PREFERS = re.compile(
    r"\b(?:i|we) (?:\w+ )?(?:like|love|enjoy|prefer|want|need|hope|wish|think|play|help|care|trust|agree)\b"
)
_DAY = re.compile(
    r"^(?:today|yesterday|tonight|this|the) ?(?:day|week|weekend|morning|evening|party|trip)? (?:is|was|has been) "
)
_CRY = re.compile(r"^(?:it|that|this|what|such|how|today|everything|life|finally|so)\b")
_POLITE = re.compile(
    r"\b(?:thanks|thank you)(?: (?:so|very) much| a lot)?\b|\bplease\b|\b(?:nice|good|pleased|glad) to (?:meet|see) you\b|"
    r"\bgood (?:morning|day|evening|night|afternoon|bye)\b|\bhave a .*"
)


def recognise(text: str, names: Iterable[str] = ()) -> Feeling | None:
    """Return the feeling that fits `text` (English), or None.

    The strongest feeling counts: sorrow, then affection, praise, joy, surprise.

    Args:
        text: The user's words; the first 1000 characters count.
        names: The agent's names.

    Raises:
        PlatformError: vaderSentiment is not installed.

    Example:
        >>> recognise("You are so clever!"), recognise("You are not very clever."), recognise("I passed my exam!")
        ('shy', None, 'happy')
    """
    said = list(sentences(text, names))
    for feeling, shows in SIGNS:
        if any(shows(sentence) for sentence in said):
            return feeling
    return next((feeling for feeling, picture in PICTURES if picture.search(text[:LONGEST])), None)


def is_affectionate(sentence: Sentence) -> bool:
    """Return whether the user shows affection to the agent."""
    return _has(sentence, AFFECTION_ASKED if sentence.asks else AFFECTION)


def praises(sentence: Sentence) -> bool:
    """Return whether the user pays the agent a compliment."""
    return not sentence.asks and (_has(sentence, PRAISE, of=IMAGINED) or any(map(is_praise, sentence.clauses)))


def saddens(sentence: Sentence) -> bool:
    """Return whether the user is in sorrow, or insults the agent."""
    return not sentence.asks and _has(sentence, SORROW)


def rejoices(sentence: Sentence) -> bool:
    """Return whether the user is happy or has good news."""
    return not sentence.asks and _has(sentence, JOY, of=IMAGINED) and polarity(sentence.text) > SAD


def wonders(sentence: Sentence) -> bool:
    """Return whether the user is surprised."""
    if not sentence.clauses:
        return "?" in sentence.end and "!" in sentence.end
    return _has(sentence, SURPRISE_ASKED if sentence.asks else SURPRISE)


def delights(sentence: Sentence) -> bool:
    """Return whether the user says something very positive about themselves, or exclaims it."""
    text = _POLITE.sub(" ", sentence.text).strip()
    if sentence.asks or IMAGINED.search(text) or re.search(r"\byou\b", text) or is_denied(text, len(text)):
        return False
    own = (_MINE.search(text) or _DAY.match(text)) and not _THEIRS.match(text) and not _PREFERS.search(text)
    cries = sentence.exclaims and (_CRY.match(text) or any(map(is_kind, text.split()[:1])))
    return bool(own or cries) and polarity(text) >= DELIGHT


SIGNS: tuple[tuple[Feeling, Callable[[Sentence], bool]], ...] = (
    ("sad", saddens),
    ("affectionate", is_affectionate),
    ("shy", praises),
    ("happy", rejoices),
    ("surprised", wonders),
    ("happy", delights),
)


def _has(sentence: Sentence, pattern: re.Pattern[str], of: re.Pattern[str] = _CONDITION) -> bool:
    """Return whether a clause has the pattern, with neither a negation nor `of` before it."""
    return any(
        not of.search(clause[: found.start()])
        and (not is_denied(clause, found.end()) or DESPITE_NOT.search(found[0]) is not None)
        for clause in sentence.clauses
        for found in pattern.finditer(clause)
    )
