"""Functions that show how nlp understands a text, and the measurement of genqa."""

from __future__ import annotations

import re
import tempfile
from collections.abc import Collection, Iterable
from concurrent.futures import ThreadPoolExecutor
from functools import cache
from pathlib import Path
from typing import ClassVar

from quality.measure import Reply, Result, facts, measure_facts
from ravestate.language.entity import Entity
from ravestate.language.matcher import bundled_matcher
from ravestate.language.network import network
from ravestate.language.normal import Normal
from ravestate.modules import genqa as genqa_module
from ravestate.modules.meta.nlp import QuestionWord, Settings, YesNo
from ravestate.modules.meta.nlp.analysis import MATCHERS, Analysis, analyse
from ravestate.modules.meta.nlp.clause import Clause
from ravestate.modules.meta.nlp.inquiry import question_of
from ravestate.modules.meta.nlp.pipeline import TOGETHER, Pipeline, pipeline
from ravestate.modules.meta.nlp.statements import statements_of
from ravestate.modules.meta.nlp.tree import Tree
from ravestate.modules.skill.genqa.answering import Answerer
from ravestate.modules.skill.genqa.following import answer_in
from ravestate.modules.skill.genqa.question import not_asked, parsed

FLAGS = ("negated", "past", "hearsay", "conditional", "plan", "question", "request")


def analysed(text: str) -> Analysis:
    return _analysed(text, (*(bundled_matcher(name).loaded for name in MATCHERS), network().loaded))


@cache
def _analysed(text: str, learnt: tuple[bool, ...]) -> Analysis:
    """Analyse a text once for all measurements. The analysis depends on `learnt`: which matchers are loaded."""
    return analyse(text, _Prepared(), Settings().agent_names)


class _Prepared(Pipeline):
    """The shared pipeline, which reuses the trees that `prepare` has made."""

    trees: ClassVar[dict[Normal, tuple[Tree, tuple[Entity, ...]]]] = {}

    def normalise(self, text: str, names: Collection[str] = ()) -> Normal:
        return pipeline("").normalise(text, names)

    def read(self, text: str | Normal) -> tuple[Tree, tuple[Entity, ...]]:
        known = self.trees.get(text) if isinstance(text, Normal) else None
        return known or pipeline("").read(text)


def prepare(texts: Iterable[str]) -> None:
    """Parse all sentences of a set in threads, so that the pipeline makes batches. This takes a third of the time."""
    normals = [pipeline("").normalise(text, Settings().agent_names) for text in texts]
    with ThreadPoolExecutor(2 * TOGETHER) as pool:
        _Prepared.trees.update(zip(normals, pool.map(pipeline("").read, normals), strict=True))


@cache
def _read(text: str) -> tuple[Tree, tuple[Entity, ...]]:
    """Parse a text. A whole analysis would take ten times as long."""
    parser = _Prepared()
    return parser.read(parser.normalise(text, Settings().agent_names))


def triples(text: str) -> list[tuple[str, str, str]]:
    """Return the triples that nlp finds in a text. A question word is given as its name."""
    tree, entities = _read(text)
    found = (statement.triple for statement in statements_of(tree, entities, Clause.all_in(tree)))
    return [(text_of(s), predicate, text_of(o)) for s, predicate, o in found]


def text_of(part: str | QuestionWord) -> str:
    return part.name if isinstance(part, QuestionWord) else part


def flags(text: str) -> str:
    """Return the flags that nlp finds on the last statement; ``-`` if the statement holds."""
    tree, entities = _read(text)
    *_, last = statements_of(tree, entities, Clause.all_in(tree))
    return "-" if last.holds else " ".join(flag for flag in FLAGS if getattr(last, flag))


def question(text: str) -> QuestionWord | None:
    """Return the kind of question that nlp finds; None if a text asks nothing."""
    network().load()
    return question_of(_Prepared().normalise(text, Settings().agent_names).unguessed)


def questions(text: str) -> str:
    """Return the label of a question."""
    kind = question(text)
    return "-" if kind is None else kind.name


def yesno(text: str) -> str:
    """Return the label of the meaning that a loaded nlp finds in an answer."""
    network().load()
    return yesno_label(analysed(text).yesno)


def yesno_label(answer: YesNo) -> str:
    """Return the label of an answer."""
    if answer.unsure:
        return "unsure"
    if answer.yes:
        return f"yes {answer.yes}"
    return f"no {answer.no}" if answer.no else "-"


def plain(text: str) -> str:
    """Return only the words of a text, so that texts can be compared."""
    return " ".join(re.findall(r"[a-z0-9]+", text.lower().replace("'", "")))


def genqa(text: str) -> Reply | None:
    """Return the reply of genqa to a question that begins a conversation."""
    settings, seen = genqa_module.Settings(), analysed(text)
    heard = parsed(seen.tree, seen.entities, seen.question)
    if not_asked(heard, seen):
        return None
    answer, _ = answer_in(_answerer(), heard, (), settings, 0.0)
    if not answer.text or answer.confidence < settings.unsure:
        return None
    return Reply(answer.text, sure=answer.confidence >= settings.sure)


@cache
def _answerer() -> Answerer:
    return Answerer(Path(tempfile.mkdtemp(prefix="ravestate-quality-")) / "index.sqlite")


def results() -> list[Result]:
    """Return the shares of genqa."""
    prepare(fact.question for fact in facts())
    return [measure_facts(genqa, facts())]
