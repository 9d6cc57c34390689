"""Measure the sets of sentences with which nlp, idle and emotion were developed.

They show whether a change breaks sentences that worked. Only sets that were not used for tuning show how well the agent
understands text. A change may lose some of these sentences if the floors in `test_language.py` still hold.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from functools import cache

from quality import measure, modules
from quality.measure import Result, labelled, measure_labels, measure_triples
from ravestate.language.acts import acts, heard
from ravestate.language.matcher import bundled_matcher
from ravestate.modules import emotion
from ravestate.modules.meta.nlp import Settings

LABELLED = (
    "questions_rows", "kinds_rows", "kinds_fresh_rows", "yesno_rows", "answers_rows", "answers_fresh_rows", "intents_rows", "quiet_rows", "emotion_rows", "feelings_rows", "acts_rows", "flags_rows",
)  # fmt: skip
SETS = ("triples_rows", "typed_rows", *LABELLED)


def acts_of(text: str) -> frozenset[str]:
    """Return the user's acts that the package `language` finds in a text."""
    bundled_matcher("acts").load()
    return frozenset(acts(heard(text)))


def acts_label(text: str) -> str:
    """Return the user's acts that the package `language` finds in a text, as a label."""
    return "+".join(sorted(acts_of(text))) or "-"


def intents(text: str) -> str:
    """Return the intents that nlp finds in a text, as a label."""
    bundled_matcher("acts").load()
    seen = modules.analysed(text)
    return "+".join(intent.removeprefix("intent_") for intent in seen.acted) or "-"


def quiet(text: str) -> str:
    """Return how idle understands a text: as a request for quiet, a farewell, or neither."""
    heard = acts_of(text)
    return "quiet" if "quiet" in heard else "leave" if "farewell" in heard else "-"


@cache
def feelings(text: str) -> str:
    """Return the feelings that emotion finds in a text, including sadness."""
    return emotion.recognise(text, Settings().agent_names) or "-"


_ANSWERING = re.compile(
    r"^\W*(?:ok|okay|sure|right|alright|all right|fine|fair|true|same|not|never|can't|i (?:do|did|have|am|was|would))\b|"
    r"\b(?:yes|yeah|yep|no|nope|nah|not|maybe|perhaps|probably|idk|don't know|i guess|okay|course)\b",
    re.IGNORECASE,
)
"""Words of a text that may be an answer."""


def ordinary_statements() -> list[str]:
    """Return the statements of `responses_rows` that are no answers: at least four words, and none of `_ANSWERING`."""
    texts = dict.fromkeys(text for text, _ in labelled("responses_rows"))
    return [text for text in texts if len(text.split()) >= 4 and not _ANSWERING.search(text)]


SEE: dict[str, Callable[[str], str]] = {
    "questions_rows": modules.questions,
    "kinds_rows": modules.questions,
    "kinds_fresh_rows": modules.questions,
    "yesno_rows": modules.yesno,
    "answers_rows": modules.yesno,
    "answers_fresh_rows": modules.yesno,
    "intents_rows": intents,
    "quiet_rows": quiet,
    "emotion_rows": feelings,
    "feelings_rows": feelings,
    "acts_rows": acts_label,
    "flags_rows": modules.flags,
}


def triples_of(notation: str) -> frozenset[tuple[str, str, str]]:
    """Read triples in the notation ``I live Hannover; My_sister sing _``."""
    parts = [triple.split() for triple in notation.split(";") if triple.strip()]
    return frozenset((_part(subject), _part(verb), _part(thing)) for subject, verb, thing in parts)


def _part(word: str) -> str:
    return "" if word == "_" else word.replace("_", " ")


def _same(triples: Iterable[tuple[str, str, str]]) -> Iterable[tuple[str, str, str]]:
    return triples


def _in_lower_case(triples: Iterable[tuple[str, str, str]]) -> Iterable[tuple[str, str, str]]:
    """Return triples in lower case, because some people type without capitals."""
    return [(subject.lower(), predicate, thing.lower()) for subject, predicate, thing in triples]


def typed() -> list[tuple[str, str]]:
    """Return messages as people type them, with their triples."""
    return list(measure.read_yaml(measure.HERE / "typed_rows.yaml").items())


@cache
def measured(name: str) -> Result:
    """Measure one of `SETS`."""
    if name in ("triples_rows", "typed_rows"):
        rows = labelled(name) if name == "triples_rows" else typed()
        cased = _same if name == "triples_rows" else _in_lower_case
        cases = [(text, frozenset(cased(triples_of(notation)))) for text, notation in rows]
        modules.prepare(text for text, _ in rows)
        result = measure_triples(lambda text: cased(modules.triples(text)), cases)
        return Result(name, result.cases, result.shares, result.misses)
    if name in (
        "questions_rows",
        "kinds_rows",
        "kinds_fresh_rows",
        "answers_rows",
        "answers_fresh_rows",
        "intents_rows",
        "flags_rows",
    ):  # the others need no tree
        modules.prepare(text for text, _ in labelled(name))
    return measure_labels(name, SEE[name], labelled(name))


def results() -> Iterable[Result]:
    """Measure all sets. `measure.py` prints the results."""
    return map(measured, SETS)
