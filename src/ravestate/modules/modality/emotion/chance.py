"""Spontaneous feelings: random ones that certain words may trigger."""

from __future__ import annotations

import random
import re
from collections.abc import Iterable, Mapping

from .feeling import Feeling
from .utterance import sentences

OCCASIONS: tuple[tuple[Feeling, re.Pattern[str]], ...] = (
    ("affectionate", re.compile(r"^(?:(?:ok|okay|well) )?(?:good)?bye\b|\bgood ?(?:night|bye)\b|\bsee you\b|\btake care\b|\bfarewell\b")),
    ("happy", re.compile(r"^(?:hi|hello|hey|hiya|howdy|greetings|good (?:morning|afternoon|evening|day))\b|\bthank(?:s| you)\b")),
    ("shy", re.compile(r"\b(?:you|your|yours|yourself)\b")),
)  # fmt: skip
"""The occasions, rare ones first. A question comes last."""


def by_chance(
    text: str, likely: Mapping[Feeling, float], rng: random.Random, names: Iterable[str] = ()
) -> Feeling | None:
    """Return a spontaneous feeling in response to `text`, or None.

    Args:
        text: The user's words.
        likely: The probability of each feeling on its occasion.
        rng: The source of chance.
        names: The agent's names.

    Example:
        >>> by_chance("What are you up to today", {"shy": 1.0}, random.Random(0))
        'shy'
    """
    said = list(sentences(text, names))
    for feeling, occasion in OCCASIONS:
        if any(occasion.search(sentence.text) for sentence in said):
            return feeling if rng.random() < likely.get(feeling, 0.0) else None
    if any(sentence.asks for sentence in said):
        return "surprised" if rng.random() < likely.get("surprised", 0.0) else None
    return None
