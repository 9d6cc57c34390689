"""The facts about the user after they told something. Nothing is saved here."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from .topics import NAME, TOPICS, Fact, in_order
from .wording import among

Facts = Mapping[str, tuple[str, ...]]
"""Values by topic; an empty tuple means that there are none."""


@dataclass(frozen=True, slots=True)
class News:
    """The result of learning.

    Attributes:
        facts: All facts.
        topics: The topics that the user told about.
        changed: Topics whose old values were replaced or removed.
        new: Topics with values that were not known.
    """

    facts: Facts
    topics: tuple[str, ...]
    changed: frozenset[str]
    new: frozenset[str]


def learn(facts: Facts, told: Iterable[Fact], instead_of: tuple[str, ...] = ()) -> News:
    """Return the facts after the user has `told` something; the name is not among them.

    Args:
        facts: The facts before.
        told: The new facts.
        instead_of: The values that they correct.

    Example:
        >>> learn({"hobby": ("chess",)}, [Fact("hobby", ("go",)), Fact("home", ("Bremen",))]).facts
        {'hobby': ('chess', 'go'), 'home': ('Bremen',)}
    """
    now = dict(facts)
    topics: list[str] = []
    changed: set[str] = set()
    new: set[str] = set()
    for fact in told:
        if fact.topic == NAME:
            continue
        topics.append(fact.topic)
        before = now.get(fact.topic)
        if fact.gone:
            _strike(now, fact)
            if fact.topic == "occupation" and not now.get("occupation"):
                topics.append("employer")
                now["employer"] = ()
        else:
            kept = _without(before or (), instead_of) if TOPICS[fact.topic].many else ()
            now[fact.topic] = kept + _without(fact.values, kept)
            if _without(fact.values, before or ()):
                new.add(fact.topic)
        if before and _without(before, now.get(fact.topic, ())):
            changed.add(fact.topic)
    return News(now, tuple(topics), frozenset(changed), frozenset(new))


def _strike(facts: dict[str, tuple[str, ...]], fact: Fact) -> None:
    left = _without(facts.get(fact.topic, ()), fact.values) if fact.values else ()
    if left or (not fact.values and TOPICS[fact.topic].kind not in ("place", "organisation")):
        facts[fact.topic] = left
    else:
        facts.pop(fact.topic, None)  # there is another value to ask about


def _without(values: Iterable[str], others: Iterable[str]) -> tuple[str, ...]:
    others = tuple(others)
    return tuple(value for value in values if not among(value, others))


def merged(remembered: Facts, told: Facts) -> Facts:
    """Return remembered facts and those of this talk together; this conversation takes precedence."""
    found = dict(remembered)
    for topic, values in told.items():
        before = remembered.get(topic, ()) if TOPICS[topic].many and values else ()
        found[topic] = before + _without(values, before)
    return {topic: found[topic] for topic in in_order(found)}


def told_apart(facts: Facts, remembered: Facts, told: Iterable[str]) -> Facts:
    """Return the facts that come from this conversation alone."""
    return {
        topic: _without(facts[topic], remembered.get(topic, ())) if TOPICS[topic].many else facts[topic]
        for topic in told
        if topic in facts
    }
