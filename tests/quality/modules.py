"""The modules as `measure.py` asks them: each function bears the name of a set."""

from __future__ import annotations

from ravestate.modules import emotion
from ravestate.modules.meta.nlp import QuestionWord, Settings
from ravestate.modules.meta.nlp.analysis import Analysis, analyse
from ravestate.modules.meta.nlp.pipeline import pipeline


def _seen(text: str) -> Analysis:
    return analyse(text, pipeline(""), Settings().agent_names)


def triples(text: str) -> list[tuple[str, str, str]]:
    """By nlp; a question word by its name."""
    return [(_text(t.subject), t.predicate, _text(t.object)) for t in _seen(text).triples]


def _text(part: str | QuestionWord) -> str:
    return part.name if isinstance(part, QuestionWord) else part


def questions(text: str) -> str:
    """By nlp."""
    kind = _seen(text).question
    return "-" if kind is None else kind.name


def yesno(text: str) -> str:
    """By nlp."""
    answer = _seen(text).yesno
    if answer.unsure:
        return "unsure"
    if answer.yes:
        return f"yes {answer.yes}"
    return f"no {answer.no}" if answer.no else "-"


def emotions(text: str) -> str:
    """By emotion."""
    return emotion.recognise(text, Settings().agent_names) or "-"
