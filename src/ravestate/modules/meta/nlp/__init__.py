"""The analysis of the user's words: words, names, triples, questions, yes and no."""

from __future__ import annotations

from ravestate.language.entity import Entity

from . import rules
from .answer import YesNo
from .names import (
    Settings,
    about_agent,
    entities,
    intent_bye,
    intent_hi,
    intent_play,
    is_question,
    lemmas,
    module,
    pos,
    question,
    tags,
    text,
    tokens,
    triples,
    yesno,
)
from .question_word import QuestionWord
from .triple import Triple

__all__ = [
    "Entity",
    "QuestionWord",
    "Settings",
    "Triple",
    "YesNo",
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
    "rules",
    "tags",
    "text",
    "tokens",
    "triples",
    "yesno",
]
