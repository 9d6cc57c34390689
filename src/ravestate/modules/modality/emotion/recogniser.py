"""Which feeling fits what was said: a compliment makes shy, affection affectionate, good news happy, a wonder surprised.

Patterns find expressions, VADER knows which words are kind, and both are taken back by negation, conditions and most
questions. What is merely pleasant ("the weather is nice") moves nobody.
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

__all__ = ["recognise"]

DELIGHT = 0.5
"""Polarity from which on a sentence about oneself, or an exclamation, is one of joy."""

SAD = -0.5
"""Polarity from which down on what is told is no joy after all: "I got my results, and I failed"."""

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
    """Return the feeling that an agent should have at hearing `text` (English), or None if there is no reason for any.

    Of several the stronger one is returned: sorrow goes before affection, affection before praise, praise before joy, joy
    before surprise.

    Args:
        text: What the user said; the first 1000 characters count.
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
    """Whether somebody says that he likes the agent."""
    return _has(sentence, AFFECTION_ASKED if sentence.asks else AFFECTION)


def praises(sentence: Sentence) -> bool:
    """Whether somebody pays the agent a compliment."""
    return not sentence.asks and (
        _has(sentence, PRAISE, of=IMAGINED) or any(map(is_praise, sentence.clauses))
    )


def saddens(sentence: Sentence) -> bool:
    """Whether somebody tells of sorrow, or insults the agent."""
    return not sentence.asks and _has(sentence, SORROW)


def rejoices(sentence: Sentence) -> bool:
    """Whether somebody tells of joy, or of good news."""
    return not sentence.asks and _has(sentence, JOY, of=IMAGINED) and polarity(sentence.text) > SAD


def wonders(sentence: Sentence) -> bool:
    """Whether somebody is surprised."""
    if not sentence.clauses:
        return "?" in sentence.end and "!" in sentence.end
    return _has(sentence, SURPRISE_ASKED if sentence.asks else SURPRISE)


def delights(sentence: Sentence) -> bool:
    """Whether somebody says something very positive of himself, or cries it out."""
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
    """Whether a clause has the pattern, without a denial, and without what is `of` a mere thought in front."""
    return any(
        not of.search(clause[: found.start()])
        and (not is_denied(clause, found.end()) or DESPITE_NOT.search(found[0]) is not None)
        for clause in sentence.clauses
        for found in pattern.finditer(clause)
    )
