"""The replies, as intents for the verbaliser."""

from __future__ import annotations

import random

from ravestate.modules.meta.verbaliser.intents import Intent

from .profile import Facts
from .told import Told
from .topics import TOPICS, in_order
from .wording import clause, joined, spoken

PACKAGE = __name__.rpartition(".")[0]
"""The package with the phrases."""


def say(intent: str, known: Facts, **parameters: str | None) -> Intent:
    """Return an intent whose phrases may use all known facts, and `parameters`."""
    mentioned = {topic: spoken(topic, values) for topic, values in known.items() if values}
    return Intent(intent, {**mentioned, **parameters}, PACKAGE)


def asking(topic: str, known: Facts) -> Intent:
    """Return the question about a topic."""
    return say(f"ask_{topic}", known)


def learned(topic: str, values: tuple[str, ...], known: Facts) -> Intent:
    """Return a reply that shows which `values` were understood."""
    if not TOPICS[topic].asked:
        return stating("learned", topic, values, known)
    return say(f"learned_{topic}", known, **{topic: spoken(topic, values)})


def stating(intent: str, topic: str, values: tuple[str, ...], known: Facts) -> Intent:
    """Return a reply that states one topic as a clause: ``{fact}``."""
    return say(intent, known, fact=clause(topic, values))


def memorable(remembered: Facts, chance: random.Random) -> str:
    """Return one of the remembered topics."""
    return chance.choice([topic for topic, values in remembered.items() if values])


def summary(known: Facts) -> Intent:
    """Return a reply that states all that is known."""
    return say("recall_everything", known, facts=clauses(known))


def clauses(known: Facts) -> str:
    """Return all that is known, one clause per topic."""
    return joined([clause(topic, known[topic]) for topic in in_order(known) if known[topic]])


def following(topic: str, known: Facts) -> Intent:
    """Return a personal question between two questions about facts: about the last topic, if there is one for it."""
    fit = topic in FOLLOWED and known.get(topic)
    return say(f"more_{topic}" if fit else "more", known)


def picking_up(one: Told, known: Facts) -> Intent:
    """Return a question about what the user told."""
    if one.verb == "be" and one.subject.lower().startswith("my "):
        return say("how_is", known, person=f"your {one.subject[3:]}")
    return say("pick_up", known, fact=one.text)


FOLLOWED = frozenset(["home", "origin", "hobby", "occupation", "subject", "friend", "club"])
"""Topics with an intent ``more_<topic>``."""
