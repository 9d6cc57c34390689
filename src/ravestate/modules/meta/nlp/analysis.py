"""The whole analysis of a text."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field

from ravestate.language.entity import Entity
from ravestate.language.matcher import Match, Matcher, bundled_matcher
from ravestate.language.normal import Normal
from ravestate.language.sentences import sentences as sentences_of

from .answer import YesNo, yesno_of
from .game import wants_to_play
from .greeting import says_bye, says_hi
from .inquiry import question_of
from .pipeline import Pipeline
from .question_word import QuestionWord
from .statement import Statement
from .statements import statements_of
from .tree import Tree
from .triple import Triple
from .word_set import word_set

_SECOND_PERSON = word_set("you your yours yourself u ur")

MATCHERS = ("acts", "feelings")
"""The files of examples whose classes an analysis names."""


@dataclass(frozen=True, slots=True)
class Analysis:
    """The analysis of a text; the README explains each part."""

    text: str
    """The text as typed."""
    normal: Normal
    """The text as written English."""
    tree: Tree
    entities: tuple[Entity, ...]
    triples: tuple[Triple, ...]
    yesno: YesNo
    question: QuestionWord | None
    about_agent: bool
    intent_play: bool
    intent_hi: bool
    intent_bye: bool
    sentences: tuple[str, ...] = ()
    """The sentences of the normal form."""
    statements: tuple[Statement, ...] = ()
    """The triples with their circumstances: denied, past, hearsay..."""
    acts: Mapping[str, Match] = field(default_factory=dict[str, Match])
    """The user's acts, by the classes of ``acts.yaml``: greeting, thanks... each with its best sentence."""
    feelings: Mapping[str, Match] = field(default_factory=dict[str, Match])
    """The feelings, by the classes of ``feelings.yaml``, each with its best sentence."""

    def act(self, name: str) -> Match | None:
        """Return the best sentence with the act `name`; None if there is none."""
        return self.acts.get(name)


def analyse(text: str, pipeline: Pipeline, agent_names: Iterable[str] = ()) -> Analysis:
    """Analyse `text`. Blocks for a few milliseconds.

    Args:
        text: Any text; the analysis covers the beginning of a long one.
        pipeline: The pipeline; the first call loads it in about a second.
        agent_names: A text with one of them is about the agent. Case is ignored.

    Raises:
        PlatformError: spaCy or the pipeline is missing.
    """
    names = tuple(agent_names)
    normal = pipeline.normalise(text, names)
    tree, entities = pipeline.read(normal)
    sentences = sentences_of(normal.text)
    statements = statements_of(tree, entities)
    return Analysis(
        text=text,
        normal=normal,
        tree=tree,
        entities=entities,
        triples=tuple(statement.triple for statement in statements),
        yesno=yesno_of(tree.text),
        question=question_of(tree),
        about_agent=_is_about_agent(tree, names),
        intent_play=wants_to_play(tree.text),
        intent_hi=says_hi(tree.text),
        intent_bye=says_bye(tree.text),
        sentences=sentences,
        statements=statements,
        acts=_best(bundled_matcher("acts"), sentences),
        feelings=_best(bundled_matcher("feelings"), sentences),
    )


def _best(matcher: Matcher, sentences: Sequence[str]) -> dict[str, Match]:
    """Return the classes of the sentences, each with the best of its sentences."""
    found: dict[str, Match] = {}
    for match in matcher.match_all(sentences):
        if match is not None and (match.name not in found or match.score > found[match.name].score):
            found[match.name] = match
    return found


def _is_about_agent(tree: Tree, names: Iterable[str]) -> bool:
    if any(word.low in _SECOND_PERSON for word in tree.words):
        return True
    return any(
        re.search(rf"(?<!\w){re.escape(name.strip())}(?!\w)", tree.text, re.IGNORECASE)
        for name in names
        if name.strip()
    )
