"""What there is to say, as intents for the verbaliser."""

from __future__ import annotations

import random

from ravestate.modules.meta.verbaliser.intents import Intent

from .profile import Facts
from .topics import TOPICS, in_order
from .wording import clause, joined, spoken

__all__ = ["asking", "clauses", "learned", "memorable", "say", "stating", "summary"]

PACKAGE = __name__.rpartition(".")[0]
"""Where the phrases are."""


def say(intent: str, known: Facts, **parameters: str | None) -> Intent:
    """Return an intent whose phrases may mention all that is known, and `parameters`."""
    mentioned = {topic: spoken(topic, values) for topic, values in known.items() if values}
    return Intent(intent, {**mentioned, **parameters}, PACKAGE)


def asking(topic: str, known: Facts) -> Intent:
    """Ask about a topic."""
    return say(f"ask_{topic}", known)


def learned(topic: str, values: tuple[str, ...], known: Facts) -> Intent:
    """Show that `values` were understood."""
    if not TOPICS[topic].asked:
        return stating("learned", topic, values, known)
    return say(f"learned_{topic}", known, **{topic: spoken(topic, values)})


def stating(intent: str, topic: str, values: tuple[str, ...], known: Facts) -> Intent:
    """Say something that has what is known about one topic as a clause: ``{fact}``."""
    return say(intent, known, fact=clause(topic, values))


def memorable(remembered: Facts, chance: random.Random) -> str:
    """One of the topics about which something is remembered."""
    return chance.choice([topic for topic, values in remembered.items() if values])


def summary(known: Facts) -> Intent:
    """Tell the user all that is known of him."""
    return say("recall_everything", known, facts=clauses(known))


def clauses(known: Facts) -> str:
    """What is known, each topic as a clause."""
    return joined([clause(topic, known[topic]) for topic in in_order(known) if known[topic]])
