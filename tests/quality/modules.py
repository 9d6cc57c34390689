"""The functions for `measure.py`; each has the name of a set."""

from __future__ import annotations

import re
import tempfile
from dataclasses import replace
from functools import cache
from pathlib import Path

from quality.measure import Reply, labelled
from ravestate.language.matcher import bundled_matcher
from ravestate.modules import emotion
from ravestate.modules import genqa as genqa_module
from ravestate.modules.meta.nlp import QuestionWord, Settings, YesNo
from ravestate.modules.meta.nlp.analysis import Analysis, analyse
from ravestate.modules.meta.nlp.pipeline import pipeline
from ravestate.modules.skill.agentqa.life import Life
from ravestate.modules.skill.agentqa.life_file import read_life
from ravestate.modules.skill.agentqa.router import Match, Router
from ravestate.modules.skill.genqa.answering import Answerer


def _seen(text: str) -> Analysis:
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


def emotions(text: str) -> str:
    """By emotion; the set does not know sadness."""
    found = emotion.recognise(text, Settings().agent_names)
    return "-" if found in (None, "sad") else found


NOT_ABOUT_ITSELF = ("time", "date", "privacy")
"""Topics of agentqa that the set, which asks about the agent alone, leaves to others."""


def agentqa(text: str) -> str:
    """Classify with agentqa, which needs nlp's verdict whether the text is a question."""
    found = _router().route(text, question=_seen(text).question is not None)
    topic = found.topic if isinstance(found, Match) else "-"
    return {"abilities": "can_do", **dict.fromkeys(NOT_ABOUT_ITSELF, "-")}.get(topic, topic)


def plain(text: str) -> str:
    """The words of a text alone, for telling whether two are the same."""
    return " ".join(re.findall(r"[a-z0-9]+", text.lower().replace("'", "")))


@cache
def _router() -> Router:
    """A router that has not learnt from any sentence of the set: everyday questions stand among its examples, too."""
    life, measured = read_life(), {plain(text) for text, _ in labelled("agentqa")}

    def others(examples: tuple[str, ...]) -> tuple[str, ...]:
        return tuple(example for example in examples if plain(example) not in measured)

    topics = {name: replace(t, questions=others(t.questions)) for name, t in life.topics.items()}
    return Router(Life(life.facts, topics, others(life.others)))


def genqa(text: str) -> Reply | None:
    """By genqa, which is only asked what nlp takes for a question."""
    settings = genqa_module.Settings()
    if _seen(text).question is None:
        return None
    answer = _answerer().answer(text)
    if not answer.text or answer.confidence < settings.unsure:
        return None
    return Reply(answer.text, sure=answer.confidence >= settings.sure)


@cache
def _answerer() -> Answerer:
    return Answerer(Path(tempfile.mkdtemp(prefix="ravestate-quality-")) / "index.sqlite")
