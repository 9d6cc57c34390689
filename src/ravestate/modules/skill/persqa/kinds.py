"""Classifiers: of nouns (places, jobs, names...), and of the user's reactions to the agent's questions."""

from __future__ import annotations

from functools import cache
from importlib.resources import files

from ravestate.language.examples import read_examples
from ravestate.language.matcher import Matcher
from ravestate.language.tagger import tagger

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
"""A topic's kind or name → the classes in `nouns.yaml` whose nouns may be values of the topic."""
_FOLDER = files(__name__.rpartition(".")[0])


@cache
def nouns() -> Matcher:
    """Return the classifier of nouns. It may not be loaded yet."""
    return Matcher(read_examples(_FOLDER / "nouns.yaml").classes, least=0.0, shapes=0.0)


def kind_of(value: str) -> str:
    """Return the class of nouns that a value fits best; empty if unsure."""
    ranked = nouns().ranked(value)
    return ranked[0].name if ranked else ""


@cache
def acts() -> Matcher:
    """Return the classifier of the user's reactions to the agent's questions. It may not be loaded yet."""
    found = read_examples(_FOLDER / "acts.yaml")
    return Matcher(found.classes, found.none)


def likeness(value: str, kind: str) -> float:
    """Return the fit of a value to `kind`, minus its best fit to another kind: about -1 to 1; 0 if unsure."""
    ranked = nouns().ranked(value)
    fitting = [match.margin for match in ranked if match.name in FITTING[kind]]
    return max(fitting, default=-1.0 if ranked and ranked[0].name else 0.0)


def load() -> None:
    """Load the classifiers and the tagger, unless they are loaded.

    Raises:
        PlatformError: The sentence model is missing.
    """
    nouns().load()
    acts().load()
    tagger().load()
