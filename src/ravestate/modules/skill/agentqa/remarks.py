"""Remarks that the agent must answer, such as signs of distress.

A remark matches an expression of a topic, or shows an act or a feeling that the topic lists. An act is a kind of
utterance, such as an insult.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass

from ravestate.language import plain
from ravestate.language.acts import heard, is_playful
from ravestate.language.addressing import addressed
from ravestate.modules.meta.nlp.analysis import Analysis

from .life import Life, whole_words

SURE = 0.9
"""The least confidence at which an act or a feeling counts as a remark. It is high, because banter resembles insults."""
_YOU = frozenset(["you", "your"])
_I = frozenset(["i", "me", "my", "myself"])
_ORDERS = frozenset(["shut", "go", "get", "fuck", "piss", "screw", "stop"])
"""The first words of insulting orders."""


@dataclass(frozen=True, slots=True)
class Remark:
    """A remark that belongs to a topic."""

    topic: str
    text: str
    """The sentence in the plain form: lower case, no punctuation, short forms written out."""


def remark_in(utterance: str, life: Life, names: Collection[str] = ()) -> Remark | None:
    """Return the remark that matches an expression of a topic; None if there is none.

    If several topics match, take the first in `life`.

    Args:
        utterance: The user's words.
        life: The agent's life story, with the topics and their remarks.
        names: Further names of the agent.

    Example:
        >>> from ravestate.modules.skill.agentqa.life_file import read_life
        >>> remark_in("Hi! I want to die.", read_life()).topic
        'distress'
    """
    called = (life.name, *names)
    said = [plain(addressed(sentence, called)) for sentence in heard(utterance, called)]
    for name, topic in life.topics.items():
        for text in said:
            if any(whole_words(expression).search(text) for expression in topic.remarks):
                return Remark(name, text)
    return None


def act_in(analysis: Analysis, life: Life) -> Remark | None:
    """Return the remark that shows an act or a feeling of a topic; None if there is none.

    If several topics match, take the first in `life`. A feeling counts only if its sentence says *you*, or is the only
    sentence. So *useless* does not count in *useless. how long do eggs boil*. An insult does not count if it is playful,
    or if users mean themselves.
    """
    for name, topic in life.topics.items():
        for known in topic.acts:
            found = analysis.acts.get(known) or analysis.feelings.get(known)
            aside = known not in analysis.acts and len(analysis.sentences) > 1
            sure = (
                found is not None and found.score >= SURE and "say_word" not in analysis.asks
            )  # "say damn" is a request
            if (
                known == "insult"
                and found is not None
                and (is_playful(analysis.text) or _of_oneself(found.text, analysis))
            ):
                continue
            if found is not None and analysis.closing is not None and analysis.closing.outweighs(found.text):
                continue
            if found is not None and sure and not (aside and _YOU.isdisjoint(plain(found.text).split())):
                return Remark(name, plain(found.text))
    return None


def _of_oneself(text: str, analysis: Analysis) -> bool:
    """Return whether users say harsh words about themselves: *dumb, I feel so dumb*."""
    words, all_words = plain(text).split(), set(plain(analysis.text).split())
    return _YOU.isdisjoint(words) and words[0] not in _ORDERS and not _I.isdisjoint(all_words)
