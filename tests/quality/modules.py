"""Functions that show how nlp understands a text, for the sets; and genqa on its own set."""

from __future__ import annotations

import re
import tempfile
from functools import cache
from pathlib import Path

from quality.measure import Reply, Result, facts, measure_facts
from ravestate.language.matcher import bundled_matcher
from ravestate.modules import genqa as genqa_module
from ravestate.modules.meta.nlp import QuestionWord, Settings, YesNo
from ravestate.modules.meta.nlp.analysis import MATCHERS, Analysis, analyse
from ravestate.modules.meta.nlp.pipeline import pipeline
from ravestate.modules.skill.genqa.answering import Answerer
from ravestate.modules.skill.genqa.following import answer_in
from ravestate.modules.skill.genqa.question import not_asked, parsed


def _seen(text: str) -> Analysis:
    return _analysed(text, tuple(bundled_matcher(name).loaded for name in (*MATCHERS, "answers")))


@cache
def _analysed(text: str, learnt: tuple[bool, ...]) -> Analysis:
    """Analyse a text once for all measures: the analysis depends on which matchers have learnt their examples."""
    return analyse(text, pipeline(""), Settings().agent_names)


def triples(text: str) -> list[tuple[str, str, str]]:
    """By nlp; a question word by its name."""
    return [(_text(s), predicate, _text(o)) for s, predicate, o in _seen(text).triples]


def _text(part: str | QuestionWord) -> str:
    return part.name if isinstance(part, QuestionWord) else part


def questions(text: str) -> str:
    """By nlp."""
    kind = _seen(text).question
    return "-" if kind is None else kind.name


def yesno(text: str) -> str:
    """By nlp, with the examples learnt."""
    bundled_matcher("answers").load()
    return yesno_label(_seen(text).yesno)


def yesno_label(answer: YesNo) -> str:
    """Return the label of an answer."""
    if answer.unsure:
        return "unsure"
    if answer.yes:
        return f"yes {answer.yes}"
    return f"no {answer.no}" if answer.no else "-"


def plain(text: str) -> str:
    """The words of a text alone, for telling whether two are the same."""
    return " ".join(re.findall(r"[a-z0-9]+", text.lower().replace("'", "")))


def genqa(text: str) -> Reply | None:
    """By genqa, without a talk before."""
    settings, seen = genqa_module.Settings(), _seen(text)
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
    return [measure_facts(genqa, facts())]
