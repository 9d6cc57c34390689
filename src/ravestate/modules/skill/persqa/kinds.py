"""The kinds of nouns: a place, a job, a name, or nothing that a topic could have as its value."""

from __future__ import annotations

from functools import cache
from importlib.resources import files

from ravestate.language.examples import read_examples
from ravestate.language.matcher import Matcher

FITTING = {
    "name": ("person",),
    "people": ("person",),
    "place": ("place",),
    "work": ("job",),
    "organisation": ("workplace", "group"),
    "club": ("group",),
    "university": ("school",),
    "subject": ("studies",),
    "activity": ("activity",),
    "trait": ("trait",),
    "possession": ("possession",),
}
"""The classes of `nouns.yaml` that are values of each kind of topic, or of one topic."""
_FOLDER = files(__name__.rpartition(".")[0])


@cache
def nouns() -> Matcher:
    """Return the classifier of nouns, loaded or not."""
    return Matcher(read_examples(_FOLDER / "nouns.yaml").classes, least=0.0, shapes=0.0)


@cache
def acts() -> Matcher:
    """Return the classifier of what the user does towards the agent's questions, loaded or not."""
    found = read_examples(_FOLDER / "acts.yaml")
    return Matcher(found.classes, found.none)


def likeness(value: str, kind: str) -> float:
    """Return how well a value fits a kind: its distance from the nearest class of another kind, about -1 to 1; 0 if unsure."""
    ranked = nouns().ranked(value)
    fitting = [match.margin for match in ranked if match.name in FITTING[kind]]
    return max(fitting, default=-1.0 if ranked and ranked[0].name else 0.0)


def is_remark(value: str) -> bool:
    """Return whether a value is rather a remark, a time or a state than an answer."""
    ranked = nouns().ranked(value)
    return bool(ranked) and ranked[0].name in ("remark", "state", "time") and ranked[0].margin > 0.15


def load() -> None:
    """Learn both classifiers, once.

    Raises:
        PlatformError: The sentence model is missing.
    """
    nouns().load()
    acts().load()
