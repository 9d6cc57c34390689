"""What people are asked about: one table."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from typing import Literal

__all__ = ["NAME", "TOPICS", "Fact", "Topic", "due"]

Kind = Literal["name", "place", "activity", "work", "organisation", "subject", "people"]
"""What the words of an answer are; it decides how they are read and written."""


@dataclass(frozen=True, slots=True)
class Topic:
    """Something to know of a person.

    Its phrases are the intents ``ask_<name>`` and ``learned_<name>``.
    """

    name: str
    """Also the parameter for its values in phrases."""
    kind: Kind
    relation: str = ""
    """The relation from the person in memory; empty for the name, which is a property."""
    type: str = ""
    """The type of the node at its other end."""
    clause: str = ""
    """What is known, said to the person."""
    many: bool = False
    """Whether there may be several."""
    only_with: str = ""
    """The topic that must be known for this one to be asked: its follow-up."""


NAME = "name"

TOPICS: Mapping[str, Topic] = {
    topic.name: topic
    for topic in (
        Topic(NAME, "name", clause="your name is {}"),
        Topic("home", "place", "lives_in", "Place", "you live in {}"),
        Topic("origin", "place", "comes_from", "Place", "you come from {}"),
        Topic("hobby", "activity", "has_hobby", "Hobby", "you like {}", many=True),
        Topic("occupation", "work", "works_as", "Occupation", "you are {}"),
        Topic("employer", "organisation", "works_for", "Organisation", "you work for {}", only_with="occupation"),
        Topic("subject", "subject", "studies", "Subject", "you study {}"),
        Topic("university", "organisation", "studies_at", "Institution", "you study at {}", only_with="subject"),
        Topic("friend", "people", "friend_of", "Person", "you are a friend of {}", many=True),
        Topic("club", "organisation", "member_of", "Organisation", "you are a member of {}", many=True),
    )
}  # fmt: skip
"""All topics by name, in the order in which they are asked."""

NOT_EMPLOYED = frozenset(
    ["student", "pupil", "retired", "self-employed", "freelancer", "freelance", "pensioner"]
)
"""Occupations without an employer to ask for."""


@dataclass(frozen=True, slots=True)
class Fact:
    """What somebody has said of himself.

    Example: ``Fact("hobby", ("chess", "football"))``.
    """

    topic: str
    values: tuple[str, ...]
    gone: bool = False
    """That it is not, or no longer, so; without values: that there is none."""


def due(
    wanted: Collection[str],
    known: Mapping[str, tuple[str, ...]],
    closed: Collection[str],
    tries: Mapping[str, int],
    *,
    last: str = "",
    limit: int,
) -> str:
    """The topic to ask about next, or an empty string.

    The follow-up of the `last` topic goes first, then what was asked least, in the order of `wanted`.

    Args:
        wanted: Names of topics.
        known: The values by topic; an empty tuple means that there are none.
        closed: Topics that are not to be asked.
        tries: How often each was asked.
        last: The topic that was last talked about.
        limit: So often a topic is asked at most.

    Example:
        >>> due(["name", "home"], {"name": ("Ada",)}, [], {}, limit=2)
        'home'
    """
    open_ = [
        name
        for name in wanted
        if name not in known
        and name not in closed
        and tries.get(name, 0) < limit
        and _makes_sense(name, known)
    ]
    if not open_:
        return ""
    order = list(wanted)
    return min(open_, key=lambda name: (tries.get(name, 0), not _follows(name, last), order.index(name)))


def _follows(name: str, last: str) -> bool:
    return bool(last) and TOPICS[name].only_with == last


def _makes_sense(name: str, known: Mapping[str, tuple[str, ...]]) -> bool:
    before = TOPICS[name].only_with
    if before and not known.get(before):
        return False
    return name != "employer" or not NOT_EMPLOYED & {value.lower() for value in known["occupation"]}
