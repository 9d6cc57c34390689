"""Change the known facts when the user tells something. The functions here save nothing.

A fact has a *topic*, such as *home*, and *values*, such as *Ulm*.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from .topics import NAME, TOPICS, Fact, in_order
from .wording import Facts, without


@dataclass(frozen=True, slots=True)
class News:
    """The facts after the user has told something, and the topics that this concerns."""

    facts: Facts
    topics: tuple[str, ...]
    """The topics that the user told about."""
    changed: frozenset[str]
    """Topics whose old values were replaced or removed."""
    new: frozenset[str]
    """Topics with values that were not known."""


def learn(facts: Facts, told: Iterable[Fact]) -> News:
    """Return the user's facts, without the name, after they have told the facts `told`.

    Args:
        facts: The facts that were known before.
        told: The new facts.

    Example:
        >>> learn({"hobby": ("chess",)}, [Fact("hobby", ("go",)), Fact("home", ("Bremen",))]).facts
        {'hobby': ('chess', 'go'), 'home': ('Bremen',)}
    """
    now = dict(facts)
    topics: list[str] = []
    for fact in told:
        topic, values = fact.topic, fact.values
        if topic == NAME:
            continue
        topics.append(topic)
        if not fact.gone:
            kept = now.get(topic, ()) if TOPICS[topic].many else ()
            now[topic] = kept + without(values, kept)
            continue
        before = now.pop(topic, ())
        left = without(before, values) if values else ()
        # A user who leaves a place or an organisation may have another one, so do not note that there is none.
        if left or (not values and TOPICS[topic].kind not in ("place", "organisation")):
            now[topic] = left
        if topic == "occupation" and not left:
            topics.append("employer")
            now["employer"] = ()
    changed = {topic for topic in topics if without(facts.get(topic, ()), now.get(topic, ()))}
    new = {topic for topic in topics if without(now.get(topic, ()), facts.get(topic, ()))}
    return News(now, tuple(topics), frozenset(changed), frozenset(new))


def merged(remembered: Facts, told: Facts) -> Facts:
    """Merge remembered facts with facts of this conversation. The facts of this conversation take precedence."""
    found = dict(remembered)
    for topic, values in told.items():
        before = remembered.get(topic, ()) if TOPICS[topic].many and values else ()
        found[topic] = before + without(values, before)
    return {topic: found[topic] for topic in in_order(found)}


def told_apart(facts: Facts, remembered: Facts, told: Iterable[str]) -> Facts:
    """Return the facts that come from this conversation alone."""
    before = {topic: remembered.get(topic, ()) if TOPICS[topic].many else () for topic in told}
    return {topic: without(facts[topic], before[topic]) for topic in before if topic in facts}
