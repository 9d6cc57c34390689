"""The agent's name in a sentence stands for *you*."""

from __future__ import annotations

import re
from collections.abc import Collection

_YOU = re.compile(r"\b(?:you|your|yours|yourself)\b", re.IGNORECASE)
_AGREEING = {"is": "are", "does": "do", "has": "have", "was": "were"}


def addressed(sentence: str, names: Collection[str]) -> str:
    """Return a sentence with *you* for the agent's names; beside *you*, a name only calls the agent and is left out.

    Example:
        >>> addressed("What are Robin's hobbies?", ["Robin"]), addressed("Robin, how are you?", ["Robin"])
        ('What are your hobbies?', 'how are you?')
    """
    for name in filter(None, names):
        pattern = re.compile(rf"(?<!\w){re.escape(name)}(?P<of>'s)?(?!\w)", re.IGNORECASE)
        if pattern.search(sentence) is None:
            continue
        if _YOU.search(sentence):
            sentence = re.sub(r"^[\s,]+|[\s,]+(?=[,.!?]|$)", "", pattern.sub("", sentence))
            continue
        sentence = pattern.sub(lambda found: "your" if found["of"] else "you", sentence)
        sentence = re.sub(
            r"\b(is|does|has|was) (?=you\b)|(?<=\byou )(is|does|has|was)\b",
            lambda found: _AGREEING[found[0].strip().lower()] + (" " if found[0].endswith(" ") else ""),
            sentence,
            flags=re.IGNORECASE,
        )
    return sentence
