"""The whole analysis of a text."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass

from ravestate.language.entity import Entity

from .answer import YesNo, yesno_of
from .game import wants_to_play
from .greeting import says_bye, says_hi
from .inquiry import question_of
from .pipeline import Pipeline
from .question_word import QuestionWord
from .statements import triples_of
from .tree import Tree
from .triple import Triple
from .word_set import word_set

_SECOND_PERSON = word_set("you your yours yourself u ur")


@dataclass(frozen=True, slots=True)
class Analysis:
    """The analysis of a text; the README explains each part."""

    tree: Tree
    entities: tuple[Entity, ...]
    triples: tuple[Triple, ...]
    yesno: YesNo
    question: QuestionWord | None
    about_agent: bool
    intent_play: bool
    intent_hi: bool
    intent_bye: bool


def analyse(text: str, pipeline: Pipeline, agent_names: Iterable[str] = ()) -> Analysis:
    """Analyse `text`. Blocks for a few milliseconds.

    Args:
        text: Any text; the analysis covers the beginning of a long one.
        pipeline: The pipeline; the first call loads it in about a second.
        agent_names: A text with one of them is about the agent. Case is ignored.

    Raises:
        PlatformError: spaCy or the pipeline is missing.
    """
    tree, entities = pipeline.read(text)
    return Analysis(
        tree=tree,
        entities=entities,
        triples=triples_of(tree),
        yesno=yesno_of(tree.text),
        question=question_of(tree),
        about_agent=_is_about_agent(tree, agent_names),
        intent_play=wants_to_play(tree.text),
        intent_hi=says_hi(tree.text),
        intent_bye=says_bye(tree.text),
    )


def _is_about_agent(tree: Tree, names: Iterable[str]) -> bool:
    if any(word.low in _SECOND_PERSON for word in tree.words):
        return True
    return any(
        re.search(rf"(?<!\w){re.escape(name.strip())}(?!\w)", tree.text, re.IGNORECASE)
        for name in names
        if name.strip()
    )
