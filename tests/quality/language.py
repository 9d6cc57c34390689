"""The sentences that nlp, idle and emotion were written with, measured as sets.

They show whether a change breaks what worked; how well text is understood show the sets that nobody tuned on. A
change may lose some of these sentences as long as the floors in `test_language.py` hold.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import cache

from quality import modules
from quality.measure import Result, labelled, measure_labels, measure_triples
from ravestate.language.matcher import bundled_matcher
from ravestate.modules import emotion
from ravestate.modules.meta.idle.words import asks_for_quiet, takes_leave
from ravestate.modules.meta.nlp import Settings
from ravestate.modules.meta.nlp.analysis import analyse
from ravestate.modules.meta.nlp.answer import YesNo, yesno_of
from ravestate.modules.meta.nlp.pipeline import pipeline

LABELLED = ("questions_rows", "yesno_rows", "intents_rows", "quiet_rows", "emotion_rows")
SETS = ("triples_rows", *LABELLED)


def intents(text: str) -> str:
    """By nlp."""
    seen = analyse(text, pipeline(""), Settings().agent_names)
    found = (seen.intent_hi and "hi", seen.intent_bye and "bye", seen.intent_play and "play")
    return "+".join(filter(None, found)) or "-"


def answered(text: str) -> YesNo:
    """By nlp, with the examples learnt."""
    bundled_matcher("answers").load()
    return yesno_of(text)


def quiet(text: str) -> str:
    """By idle."""
    return "quiet" if asks_for_quiet(text) else "leave" if takes_leave(text) else "-"


def feelings(text: str) -> str:
    """By emotion, sadness included."""
    return emotion.recognise(text, Settings().agent_names) or "-"


SEE: dict[str, Callable[[str], str]] = {
    "questions_rows": modules.questions,
    "yesno_rows": lambda text: modules.yesno_label(answered(text)),
    "intents_rows": intents,
    "quiet_rows": quiet,
    "emotion_rows": feelings,
}


def triples_of(notation: str) -> frozenset[tuple[str, str, str]]:
    """Read triples: ``I live Hannover; My_sister sing _``."""
    parts = [triple.split() for triple in notation.split(";") if triple.strip()]
    return frozenset((_part(subject), _part(verb), _part(thing)) for subject, verb, thing in parts)


def _part(word: str) -> str:
    return "" if word == "_" else word.replace("_", " ")


@cache
def measured(name: str) -> Result:
    """Measure one of `SETS`."""
    if name == "triples_rows":
        cases = [(text, triples_of(notation)) for text, notation in labelled(name)]
        result = measure_triples(modules.triples, cases)
        return Result(name, result.cases, result.shares, result.misses)
    return measure_labels(name, SEE[name], labelled(name))


def results() -> Iterable[Result]:
    """Measure all sets; `measure.py` prints them."""
    return map(measured, SETS)
