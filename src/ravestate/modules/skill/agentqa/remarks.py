"""What is not asked but remarked: distress, grief, an insult, which want an answer before all else; thanks and such."""

from __future__ import annotations

import re
from collections.abc import Collection
from dataclasses import dataclass
from functools import lru_cache

from .asking import statements
from .life import Life

__all__ = ["Remark", "remark_in"]


ASIDE = 80
"""Characters that something said by the way has at most."""


@dataclass(frozen=True, slots=True)
class Remark:
    """Something that was said, and belongs to a topic."""

    topic: str
    text: str
    """The sentence, in the plain form."""


def remark_in(utterance: str, life: Life, names: Collection[str] = (), asked: bool = False) -> Remark | None:
    """Return what is remarked; of several topics the one that stands first in the life.

    Args:
        utterance: What the user said.
        life: Its topics; those that have remarks count.
        names: What else the agent is called.
        asked: Whether the agent has asked something: then *okay* is an answer, and no aside.

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
