"""Measure the sets of the skills. For each set, a function of the same name takes a sentence, and returns a label.

A sentence can begin with its situation in brackets: ``[asked home] hannover``.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from functools import cache
from typing import Any

from quality import measure, modules
from quality.modules import analysed
from ravestate.language.acts import heard, only
from ravestate.language.matcher import bundled_matcher
from ravestate.language.network import network
from ravestate.modules.meta.nlp.analysis import MATCHERS
from ravestate.modules.skill.agentqa.life_file import read_life
from ravestate.modules.skill.agentqa.remarks import act_in, remark_in
from ravestate.modules.skill.agentqa.router import Match, router_of
from ravestate.modules.skill.persqa import kinds
from ravestate.modules.skill.persqa.talk import Talk
from ravestate.modules.skill.persqa.topics import Fact
from ravestate.modules.skill.persqa.understanding import Meaning, understand
from ravestate.modules.skill.wildtalk.facts import asks_for_fact
from ravestate.modules.skill.wildtalk.listening import Listener

__all__ = ["FLOORS", "SETS", "result", "results"]

FLOORS = {
    "persqa_facts": 0.91,
    "agentqa_asks": 0.96,
    "about_rows": 0.95,
    "agentqa_remarks": 0.96,
    "genqa_declined": 0.97,
    "wildtalk_facts": 0.97,
    "hibye_words": 0.97,
}
"""The minimum share of right labels: the last result rounded down, or 0.97 if the last result was perfect."""

_SITUATION = re.compile(r"(?:\[(asked|told|knows) ([^]=]+)(?:=([^]]*))?\] )?(.*)")


def situation_in(sentence: str) -> tuple[tuple[Any, Any, Any], str]:
    """Return the parts of the situation in brackets (None if they are missing), and the sentence after it."""
    situation = _SITUATION.fullmatch(sentence)
    assert situation is not None
    what, topic, value, text = situation.groups()
    return (what, topic, value), text


def talk_before(sentence: str) -> tuple[str, Talk, dict[str, tuple[str, ...]]]:
    """Return a sentence without its situation, the talk before it, and the known facts.

    Known facts are written as ``[knows home=Ulm; age=36] ...``.
    """
    (what, topic, value), text = situation_in(sentence)
    if not what or what == "asked":
        return text, Talk().asking(topic, 0.0).speaking() if what else Talk(), {}
    pairs = (one.strip().split("=") for one in f"{topic}={value}".split(";"))
    known = {one: (had,) for one, had in pairs}
    return text, Talk().learning([topic], topic, known[topic]) if what == "told" else Talk(), known


def meaning_of(sentence: str) -> Meaning:
    """Return what the user tells or asks about themselves. The sentence can begin with its situation in brackets."""
    text, talk, known = talk_before(sentence)
    load()
    return understand(analysed(text), talk, known, now=1.0, within=90.0)


def persqa_facts(sentence: str) -> str:
    """Return what the user tells or asks about themselves, as a label."""
    meaning = meaning_of(sentence)
    facts = " ".join(map(fact_label, sorted(meaning.facts, key=lambda fact: fact.topic)))
    if meaning.kind in ("told", "corrected"):
        return facts or "-"
    if meaning.kind == "asked":
        return f"? {facts}".rstrip()
    return {"nothing": "-", "mentioned": "-"}.get(meaning.kind, meaning.kind)


@cache
def load() -> None:
    for name in MATCHERS:
        bundled_matcher(name).load()
    network().load()
    kinds.load()


@cache
def listener() -> Listener:
    bundled_matcher("acts").load()
    bundled_matcher("feelings").load()
    listener = Listener()
    listener.load()
    return listener


def fact_label(fact: Fact) -> str:
    values = "|".join(fact.values)
    return f"{'not ' if fact.gone else ''}{fact.topic}" + (f"={values}" if values else "")


@cache
def agentqa_asks(sentence: str) -> str:
    """Return the topic about the agent that a sentence asks for."""
    found = router_of(read_life()).route(sentence, question=modules.question(sentence) is not None)
    return found.topic if isinstance(found, Match) else "-"


def about_rows(sentence: str) -> str:
    """Return the topic about the agent that a sentence asks for. The sentences of this set have many styles."""
    return agentqa_asks(sentence)


@cache
def agentqa_remarks(sentence: str) -> str:
    """Return the topic of a remark that the agent must not take for small talk."""
    load()
    found = remark_in(sentence, read_life(), ["Robin"]) or act_in(analysed(sentence), read_life())
    return "-" if found is None else found.topic


def genqa_declined(sentence: str) -> str:
    """Return ``said`` if genqa answers a question; otherwise ``-``."""
    return "-" if modules.genqa(sentence) is None else "said"


def wildtalk_facts(sentence: str) -> str:
    """Return ``fact`` if a sentence asks for a fact, so that small talk must not answer it; otherwise ``-``."""
    return "fact" if asks_for_fact(sentence) else "-"


def hibye_words(sentence: str) -> str:
    """Return ``greeting`` or ``farewell`` if a sentence is only a greeting or a farewell; otherwise ``-``."""
    bundled_matcher("acts").load()
    said = heard(sentence)
    return next((act for act in ("greeting", "farewell") if only(act, said)), "-")


SETS: dict[str, Callable[[str], str]] = {
    function.__name__: function
    for function in (
        persqa_facts, agentqa_asks, about_rows, agentqa_remarks, genqa_declined, wildtalk_facts, hibye_words,
    )
}  # fmt: skip


def result(name: str) -> measure.Result:
    """Measure the set `name`."""
    cases = measure.labelled(name)
    if name not in ("wildtalk_facts", "hibye_words"):  # these two sets need no parse tree
        prepare(text for text, _ in cases)
    return measure.measure_labels(name, SETS[name], cases)


def prepare(sentences: Iterable[str]) -> None:
    """Parse all sentences without their situations."""
    modules.prepare(situation_in(sentence)[1] for sentence in sentences)


def results() -> list[measure.Result]:
    """Measure every set of this file."""
    return [result(name) for name in SETS]
