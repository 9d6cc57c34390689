"""The topics: one table of all that the agent may know about a person."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass
from typing import Literal

Kind = Literal["name", "place", "activity", "work", "organisation", "subject", "people", "thing", "number"]
"""The kind of a value. It decides how the value is read and written."""


@dataclass(frozen=True, slots=True)
class Topic:
    """Something to know about a person.

    A topic that the agent asks for has the intents ``ask_<name>`` and ``learned_<name>``.
    """

    name: str
    """The name; also the parameter of phrases with the values."""
    kind: Kind
    relation: str = ""
    """The relation from the person in memory; empty for a property of the person."""
    type: str = ""
    """The type of the node at the other end of the relation."""
    clause: str = ""
    """The clause that states the values to the user."""
    many: bool = False
    """Whether there may be several values."""
    only_with: str = ""
    """The topic that must be known before the agent asks about this one."""
    asked: bool = True
    """Whether the agent asks for it."""
    nouns: tuple[str, ...] = ()
    """Nouns for these persons or animals: *my sister*."""
    role: bool = False
    """Whether several topics share the relation; its property ``role`` then tells them apart."""
    besides: tuple[str, ...] = ()
    """Topics that make the question unnecessary: a birthplace answers the question about the origin."""


NAME = "name"


def _relative(
    name: str, relation: str, nouns: str, *, many: bool = True, role: bool = False, type: str = "Person"
) -> Topic:
    """Return the topic of a relative, or of a pet."""
    clause = f"your {name} is {{}}"
    return Topic(name, "people", relation, type, clause, many, asked=False, nouns=tuple(nouns.split("|")), role=role)


class _Topics(dict[str, Topic]):
    """The topics; favourites (*favourite food*) are topics without being listed."""

    def __missing__(self, name: str) -> Topic:
        if not name.startswith("favourite "):
            raise KeyError(name)
        return Topic(name, "thing", "favours", "Thing", f"your {name} is {{}}", asked=False, role=True)


TOPICS: Mapping[str, Topic] = _Topics(
    (topic.name, topic)
    for topic in (
        Topic(NAME, "name", clause="your name is {}"),
        Topic("home", "place", "lives_in", "Place", "you live in {}"),
        Topic("origin", "place", "comes_from", "Place", "you come from {}", besides=("birthplace", "childhood")),
        Topic("birthplace", "place", "born_in", "Place", "you were born in {}", asked=False),
        Topic("childhood", "place", "grew_up_in", "Place", "you grew up in {}", asked=False),
        Topic("age", "number", clause="you are {} years old", asked=False),
        Topic("hobby", "activity", "has_hobby", "Hobby", "you like {}", many=True),
        Topic("liking", "thing", "likes", "Thing", "you like {}", many=True, asked=False, besides=("hobby",)),
        Topic("occupation", "work", "works_as", "Occupation", "you are {}"),
        Topic("employer", "organisation", "works_for", "Organisation", "you work for {}", only_with="occupation"),
        Topic("subject", "subject", "studies", "Subject", "you study {}"),
        Topic("university", "organisation", "studies_at", "Institution", "you study at {}", only_with="subject"),
        Topic("friend", "people", "friend_of", "Person", "you are a friend of {}", many=True, nouns=("friend", "buddy", "mate", "best friend")),
        Topic("club", "organisation", "member_of", "Organisation", "you are a member of {}", many=True),
        _relative("mother", "has_mother", "mother|mum|mummy|mom|mommy|mam", many=False),
        _relative("father", "has_father", "father|dad|daddy", many=False),
        _relative("sister", "sibling_of", "sister|stepsister|half-sister", role=True),
        _relative("brother", "sibling_of", "brother|stepbrother|half-brother", role=True),
        _relative("wife", "partner_of", "wife", many=False, role=True),
        _relative("husband", "partner_of", "husband", many=False, role=True),
        _relative("partner", "partner_of", "partner|boyfriend|girlfriend|fiancé|fiancée|fiance|fiancee", many=False, role=True),
        _relative("daughter", "has_child", "daughter", role=True),
        _relative("son", "has_child", "son", role=True),
        _relative("child", "has_child", "child|kid|baby", role=True),
        _relative("dog", "has_pet", "dog|puppy", role=True, type="Animal"),
        _relative("cat", "has_pet", "cat|kitten", role=True, type="Animal"),
        _relative("pet", "has_pet", "pet", role=True, type="Animal"),
    )
)  # fmt: skip
"""All topics by name, in the order in which they are asked."""

ASKED = tuple(topic.name for topic in TOPICS.values() if topic.asked)
"""The topics that the agent asks for."""

RELATIVES = tuple(topic for topic in TOPICS.values() if topic.nouns)
"""The topics with nouns: *my sister*."""

NOT_EMPLOYED = frozenset(["student", "pupil", "retired", "self-employed", "freelancer", "freelance", "pensioner"])
"""Occupations without an employer."""


@dataclass(frozen=True, slots=True)
class Fact:
    """A fact that the user has told about themselves.

    Example: ``Fact("hobby", ("chess", "football"))``.
    """

    topic: str
    values: tuple[str, ...]
    gone: bool = False
    """Whether the fact is denied. Without values, the user says that there are none."""


def favourite(words: str) -> str:
    """Return the topic of a favourite.

    Example:
        >>> favourite("favorite Food")
        'favourite food'
    """
    return re.sub(r"^favou?rite", "favourite", words.lower().strip())


def is_topic(name: str) -> bool:
    """Return whether there is a topic of this name; any favourite is one."""
    return name in TOPICS or name.startswith("favourite ")


def about(relation: str, role: object) -> str:
    """Return the topic of a relation in memory; empty if there is none."""
    if isinstance(role, str) and is_topic(role):
        return role if TOPICS[role].relation == relation else ""
    return next((t.name for t in TOPICS.values() if t.relation == relation and not t.role), "")


def in_order(topics: Iterable[str]) -> list[str]:
    """Return topics in the order of the table, favourites last."""
    order = list(TOPICS)
    return sorted(set(topics), key=lambda name: (order.index(name) if name in order else len(order), name))


def due(
    wanted: Collection[str],
    known: Mapping[str, tuple[str, ...]],
    closed: Collection[str],
    tries: Mapping[str, int],
    *,
    last: str = "",
    limit: int,
) -> str:
    """Return the topic to ask about next, or an empty string.

    Prefer the follow-up of the `last` topic, then the topic with the fewest tries, in the order of `wanted`.

    Args:
        wanted: Names of topics.
        known: The values by topic; an empty tuple means that there are none.
        closed: Topics not to ask about.
        tries: The number of questions about each.
        last: The topic of the conversation.
        limit: The maximum number of questions about one topic.

    Example:
        >>> due(["name", "home"], {"name": ("Ada",)}, [], {}, limit=2)
        'home'
    """
    open_ = [
        name
        for name in wanted
        if name not in known and name not in closed and tries.get(name, 0) < limit and _makes_sense(name, known)
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
    if any(known.get(other) for other in TOPICS[name].besides):
        return False
    return name != "employer" or not NOT_EMPLOYED & {value.lower() for value in known["occupation"]}
