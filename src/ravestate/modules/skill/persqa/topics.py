"""The topics: one table of everything that the agent can know about a person."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass
from importlib.resources import files
from typing import Any, Literal, cast

from pydantic import TypeAdapter

from ravestate.yaml_text import load_yaml

Kind = Literal["name", "place", "activity", "work", "organisation", "subject", "people", "thing", "number"]
"""The kind of a value. Each kind has its own rules for reading and writing a value."""


@dataclass(frozen=True, slots=True)
class Topic:
    """Something to know about a person: a row of ``topics.yaml``. That file explains the columns."""

    name: str
    """The topic's name. In a phrase, a parameter with this name, such as ``{home}``, stands for the values."""
    kind: Kind
    clause: str
    relation: str = ""
    """The relation from the person in memory; empty for a property of the person."""
    type: str = ""
    """The type of the node at the other end of the relation."""
    role: bool = False
    many: bool = False
    asked: bool = False
    only_with: str = ""
    besides: tuple[str, ...] = ()
    nouns: tuple[str, ...] = ()
    ends: tuple[str, ...] = ()
    asks: tuple[str, ...] = ()
    touching: tuple[str, ...] = ()
    ages: tuple[int, int] = (14, 120)


@dataclass(frozen=True, slots=True)
class Fact:
    """A fact that the user has told about themselves.

    Example: ``Fact("hobby", ("chess", "football"))``.
    """

    topic: str
    values: tuple[str, ...] = ()
    gone: bool = False
    """Whether the user denies the fact. If `values` is empty, the user has none, for example no hobby."""


class _Topics(dict[str, Topic]):
    """The topics. Every favourite, such as *favourite food*, is a topic, although the file does not list it."""

    def __missing__(self, name: str) -> Topic:
        if not name.startswith("favourite "):
            raise KeyError(name)
        return Topic(name, "thing", f"your {name} is {{}}", "favours", "Thing", role=True)


NAME = "name"
LASTING = frozenset(["subject", "university", "birthplace", "childhood"])
"""Topics whose facts may be in the past tense: *I studied law*."""
NOW = frozenset(["tonight", "today", "tomorrow", "now", "this"])
"""Words for a time that makes a statement momentary."""
_FILE = files(__name__.rpartition(".")[0]) / "topics.yaml"
_TABLE: dict[str, Any] = load_yaml(_FILE.read_text(encoding="utf-8"), str(_FILE))
_ROWS = TypeAdapter(list[Topic]).validate_python([{"name": name, **row} for name, row in _TABLE.pop("topics").items()])

TOPICS: Mapping[str, Topic] = _Topics((topic.name, topic) for topic in _ROWS)
"""All topics by name, in the order of the file."""
ASKED = tuple(topic.name for topic in _ROWS if topic.asked)
"""The topics that the agent asks about, in this order."""
WORDS = {name: frozenset(words) for name, words in cast("dict[str, list[str]]", _TABLE).items()}
"""Name of a list of words in ``topics.yaml`` → its words."""
NOUNS = {noun: topic.name for topic in _ROWS for noun in topic.nouns}
ENDS = {phrase: topic.name for topic in _ROWS for phrase in topic.ends}
_NATIONS: dict[str, Any] = load_yaml(
    (files(__name__.rpartition(".")[0]) / "nations.yaml").read_text(encoding="utf-8"), "nations.yaml"
)
NATIONS = {word: country for country, words in _NATIONS["nations"].items() for word in words}
"""A word for the people of a country → the country."""
ASKS = {phrase: topic.name for topic in _ROWS for phrase in topic.asks}


def favourite(words: str) -> str:
    """Return the topic of a favourite.

    Example:
        >>> favourite("favorite Food")
        'favourite food'
    """
    return re.sub(r"^favou?rite", "favourite", words.lower().strip())


def is_topic(name: str) -> bool:
    """Return whether there is a topic of this name; every favourite counts as a topic."""
    return name in TOPICS or name.startswith("favourite ")


def about(relation: str, role: object) -> str:
    """Return the topic of a relation in memory; empty if there is none."""
    if isinstance(role, str) and is_topic(role):
        return role if TOPICS[role].relation == relation else ""
    return next((t.name for t in _ROWS if t.relation == relation and not t.role), "")


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
    touched: Collection[str] = (),
    limit: int,
) -> str:
    """Return the topic to ask about next, or an empty string.

    The topic with the fewest tries comes first. If several have the fewest, the topic `name` comes first. Then come
    the topics whose `only_with` is the topic `last`, and then the topics in `touched`.

    A topic is left out if it does not suit the user's age, or if it needs a fact that is not known. It is also left out
    if the user has said none of its typical words, or if a topic in its `besides` is known. The topic `employer` is
    left out if the user's occupation has no employer.

    Args:
        wanted: The names of the topics to choose from.
        known: The values by topic; an empty tuple means that there are none.
        closed: Topics not to ask about.
        tries: The number of questions that the agent has asked about each topic.
        last: The topic that the agent learnt or mentioned most recently.
        touched: Topics for which the user has used typical words (see `touched_by`).
        limit: The maximum number of questions about one topic.

    Example:
        >>> due(["name", "home"], {"name": ("Ada",)}, [], {}, limit=2)
        'home'
    """
    done = {*known, *closed, *(name for name in tries if tries[name] >= limit)}
    left = [name for name in wanted if name not in done and _makes_sense(TOPICS[name], known, touched)]
    return min(
        left,
        key=lambda name: (
            tries.get(name, 0),
            name != NAME,
            not last or TOPICS[name].only_with != last,
            name not in touched,
        ),
        default="",
    )


def touched_by(words: Collection[str]) -> frozenset[str]:
    """Return the topics that have one of their typical words among the lemmas of an utterance."""
    return frozenset(topic.name for topic in _ROWS if not {*topic.nouns, *topic.touching}.isdisjoint(words))


def _makes_sense(topic: Topic, known: Mapping[str, tuple[str, ...]], touched: Collection[str]) -> bool:
    youngest, oldest = topic.ages
    if (topic.touching and topic.name not in touched) or not youngest <= int([*known.get("age", ()), 30][0]) <= oldest:
        return False
    needed = known.get(topic.only_with, ()) if topic.only_with else ("",)
    if not needed or any(known.get(other) for other in topic.besides):
        return False
    return topic.name != "employer" or not WORDS["not_employed"] & {value.lower() for value in needed}
