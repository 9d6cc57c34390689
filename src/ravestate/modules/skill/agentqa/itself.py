"""The agent in its own memory: a node with its facts as properties and relations, kept as the file of its life says."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

from ravestate.modules.meta.ontology import Memory, Node

from .life import Fact, Life

__all__ = ["RELATIONS", "recall", "settle"]


class _Relation(NamedTuple):
    name: str
    type: str


RELATIONS: Mapping[str, _Relation] = {
    "home": _Relation("lives_in", "Place"),
    "origin": _Relation("comes_from", "Place"),
    "hobbies": _Relation("has_hobby", "Hobby"),
    "likes": _Relation("likes", "Thing"),
    "dislikes": _Relation("dislikes", "Thing"),
    "abilities": _Relation("can", "Ability"),
    "learned": _Relation("has_learned", "Ability"),
    "ambition": _Relation("wants_to_become", "Thing"),
    "friends": _Relation("friend_of", "Agent"),
    "father": _Relation("has_father", "Agent"),
    "mother": _Relation("has_mother", "Agent"),
    "siblings": _Relation("sibling_of", "Agent"),
    "membership": _Relation("member_of", "Organisation"),
    "makers": _Relation("made_by", "Organisation"),
}
"""The facts that memory has a relation for, and of what type it makes what they name. Other facts stand in the file."""


async def settle(life: Life, memory: Memory) -> Node:
    """Make memory's node of the agent what the file says of it: facts that the file has replace those in memory; of
    facts that it does not mention, memory keeps what it has.

    Raises:
        PlatformError: Memory failed.
    """
    node = await memory.ensure("Robot", name=life.name)
    changed = False
    if life.born is not None and node.get("born") != life.born:
        node, changed = await memory.update(node, born=life.born), True
    known = await memory.relations(node)
    for fact, (relation, type) in RELATIONS.items():
        if fact not in life.facts:
            continue
        wanted = list(dict.fromkeys(texts(life.facts[fact])))
        there = [one.target for one in known if one.name == relation and one.source == node]
        for other in there:
            if other.get("name") not in wanted:
                changed = True
                await memory.unrelate(node, relation, other)
        for text in wanted:
            if text not in [other.get("name") for other in there]:
                changed = True
                await memory.relate(node, relation, await memory.ensure(type, name=text))
    if changed:
        await memory.tidy()  # the first time that was a whole life
    return node


async def recall(life: Life, memory: Memory) -> Mapping[str, Fact]:
    """Return the agent's facts: what its node in memory says, and for the rest the file.

    Raises:
        PlatformError: Memory failed.
    """
    found = await memory.find("Robot", name=life.name)
    if not found:
        return life.facts
    node = found[0]
    facts = dict(life.facts)
    if node.get("born") is not None:
        facts["born"] = node["born"].isoformat()
    known = await memory.relations(node)
    for fact, (relation, _) in RELATIONS.items():
        names = [
            str(one.target.get("name", "")) for one in known if one.name == relation and one.source == node
        ]
        before = texts(facts.get(fact, ()))
        order = {name: place for place, name in enumerate(before)}  # as in the file, the new ones last
        facts[fact] = tuple(sorted(filter(None, names), key=lambda name: order.get(name, len(order))))
    return facts


def texts(fact: Fact) -> tuple[str, ...]:
    """A fact as texts; of pairs the first ones."""
    if isinstance(fact, str):
        return (fact,)
    return tuple(part if isinstance(part, str) else part[0] for part in fact)
