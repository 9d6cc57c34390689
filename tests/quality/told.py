"""Measure the development sets of facts that users tell, and the set of changes of known facts."""

from __future__ import annotations

from collections.abc import Iterable

from quality import blind, skills
from quality.measure import Result
from ravestate.modules.skill.persqa.profile import learn
from ravestate.modules.skill.persqa.topics import NAME

SETS = ("told_rows", "told_blind_rows", "told_fresh_rows", "told_later_rows", "told_typed_rows", "names_rows")


def changes(sentence: str) -> frozenset[str]:
    """Return how an utterance changes the known facts: the values that it removes, and the values that it adds."""
    _, _, known = skills.talk_before(sentence)
    meaning = skills.meaning_of(sentence)
    if meaning.kind in ("strike", "forget", "mistaken"):
        return frozenset([meaning.kind])
    if meaning.kind not in ("told", "corrected"):
        return frozenset()
    facts = dict(learn(known, meaning.facts).facts)
    for name in sorted((fact for fact in meaning.facts if fact.topic == NAME), key=lambda fact: not fact.gone):
        if not name.gone:
            facts[NAME] = name.values
        elif not name.values or {*name.values} & {*known.get(NAME, ())}:  # "I am not Bob" leaves another name
            facts[NAME] = ()
    new = {f"{topic}={value}" for topic in facts for value in facts[topic] if value not in known.get(topic, ())}
    kept = {topic for topic in known if facts.get(topic) and topic in blind.SINGLE}  # a new value replaces the old one
    gone = {
        f"not {topic}={old}" for topic in known.keys() - kept for old in known[topic] if old not in facts.get(topic, ())
    }
    return frozenset(one.lower() for one in new | gone)


def measured_changes() -> list[Result]:
    """Measure how often an utterance rightly changes no known fact, and how often a change is right."""
    cases = {kind: blind.facts((kind,), "../changes_rows") for kind in ("left", "changed")}
    skills.prepare(text for rows in cases.values() for text, _ in rows)
    found: list[Result] = []
    for kind, rows in cases.items():
        seen = {text: changes(text) for text, _ in rows}
        wrong = [(text, label) for text, label in rows if not blind.fits(label, seen[text])]
        misses = [f"{text!r}: {'; '.join(sorted(seen[text])) or '-'} instead of {label}" for text, label in wrong]
        found.append(Result(f"changes, {kind}", len(rows), {"right": 1 - len(wrong) / len(rows)}, misses))
    return found


def results() -> Iterable[Result]:
    """Measure the sets, and list their misses."""
    yield from measured_changes()
    for name in SETS:
        yield from blind.measured_facts(f"../{name}", show=True)
