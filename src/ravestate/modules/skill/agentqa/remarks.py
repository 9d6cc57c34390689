"""Remarks that the agent must answer: distress, grief and insults first; thanks and the like."""

from __future__ import annotations

import re
from collections.abc import Collection
from dataclasses import dataclass
from functools import lru_cache

from .asking import statements
from .life import Life

ASIDE = 80
"""The maximum number of characters in an aside."""


@dataclass(frozen=True, slots=True)
class Remark:
    """A remark that belongs to a topic."""

    topic: str
    text: str
    """The sentence in the plain form."""


def remark_in(utterance: str, life: Life, names: Collection[str] = (), asked: bool = False) -> Remark | None:
    """Return the remark in an utterance. If several topics match, the first in the life counts.

    Args:
        utterance: The user's words.
        life: The life; its topics with remarks count.
        names: Further names of the agent.
        asked: Whether the agent has asked something: then *okay* is an answer, not an aside.

    Example:
        >>> from ravestate.modules.skill.agentqa.life_file import read_life
        >>> remark_in("Hi! I'm so sad, my dog has died.", read_life()).topic
        'grief'
    """
    said = statements(utterance, (life.name, *names))
    for name, topic in life.topics.items():
        if topic.remarks:
            expression = _whole_words(topic.remarks)
            for text in said:
                if expression.search(text):
                    return Remark(name, text)
    if not asked and len(utterance) < ASIDE:
        text = " ".join(re.findall(r"[\w']+", utterance.lower().replace("’", "'")))
        for name, topic in life.topics.items():
            if topic.asides and _whole_words(topic.asides).fullmatch(text):
                return Remark(name, text)
    return None


@lru_cache(maxsize=256)
def _whole_words(expressions: tuple[str, ...]) -> re.Pattern[str]:
    return re.compile(rf"(?<!\S)(?:{'|'.join(f'(?:{one})' for one in expressions)})(?!\S)")
