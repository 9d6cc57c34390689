"""Analyse the user's utterances: word forms, names, triples, questions, yes and no."""

from __future__ import annotations

from ravestate.language.entity import Entity
from ravestate.language.matcher import Match

from . import rules
from .analysis import Analysis
from .answer import YesNo
from .intent import intent
from .names import (
    Settings,
    about_agent,
    analysis,
    entities,
    intent_bye,
    intent_hi,
    intent_play,
    intents,
    is_question,
    lemmas,
    module,
    normal,
    pos,
    question,
    reader,
    tags,
    text,
    tokens,
    triples,
    yesno,
)
from .phrase import Phrase
from .question_word import QuestionWord
from .reading import ModelReader, Reading
from .statement import Statement, Triple

__all__ = [
    "Analysis",
    "Entity",
    "Match",
    "ModelReader",
    "Phrase",
    "QuestionWord",
    "Reading",
    "Settings",
    "Statement",
    "Triple",
    "YesNo",
    "about_agent",
    "analysis",
    "entities",
    "intent",
    "intent_bye",
    "intent_hi",
    "intent_play",
    "intents",
    "is_question",
    "lemmas",
    "module",
    "normal",
    "pos",
    "question",
    "reader",
    "rules",
    "tags",
    "text",
    "tokens",
    "triples",
    "yesno",
]
