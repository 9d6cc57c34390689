"""Replace the agent's name in a sentence by *you*."""

from __future__ import annotations

import re
from collections.abc import Collection

_YOU = re.compile(r"\b(?:you|your|yours|yourself)\b", re.IGNORECASE)
_AGREEING = {"is": "are", "does": "do", "has": "have", "was": "were"}


def addressed(sentence: str, names: Collection[str]) -> str:
    """Replace the agent's names and *this robot* by *you*.

    If the sentence has a *you* already, drop names that only address the agent.

    Example:
        >>> addressed("What are Robin's hobbies?", ["Robin"]), addressed("Robin, how are you?", ["Robin"])
        ('What are your hobbies?', 'how are you?')
    """
    agent = "|".join(["th(?:is|at) (?:little |cute )?robot", *(re.escape(name) for name in names if name)])
    name = rf"(?<!\w)(?:{agent})(?!\w)"
    if re.search(name, sentence, re.IGNORECASE) is None:
        return sentence
    if _YOU.search(sentence):
        called = re.sub(rf"{name}(?!'s| (?:is|has|was|does)\b)", "", sentence, flags=re.IGNORECASE)
        sentence = re.sub(r"^[\s,]+|[\s,]+(?=[,.!?]|$)", "", called) if called != sentence else sentence
    for end, you in ((r"'s(?= (?:so|very|really|such|quite|an?|the|not)\b)", "you are"), ("'s", "your"), ("", "you")):
        sentence = re.sub(name + end, you, sentence, flags=re.IGNORECASE)
    verb = re.compile(r"\b(?:is|does|has|was)(?= you\b)|(?<=\byou )(?:is|does|has|was)\b", re.IGNORECASE)
    return verb.sub(lambda found: _AGREEING[found[0].lower()], sentence)
