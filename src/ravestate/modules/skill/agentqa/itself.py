"""The agent's node in memory. Its properties and relations are facts from the agent's life file."""

from __future__ import annotations

from collections.abc import Mapping

from ravestate.modules.meta.ontology import Graph, Memory, Node

from .life import Fact, Life

RELATIONS: Mapping[str, tuple[str, str]] = {
    "home": ("lives_in", "Place"),
    "origin": ("comes_from", "Place"),
    "hobbies": ("has_hobby", "Hobby"),
    "likes": ("likes", "Thing"),
    "dislikes": ("dislikes", "Thing"),
    "abilities": ("can", "Ability"),
    "learned": ("has_learned", "Ability"),
    "ambition": ("wants_to_become", "Thing"),
    "friends": ("friend_of", "Agent"),
    "father": ("has_father", "Agent"),
    "mother": ("has_mother", "Agent"),
    "siblings": ("sibling_of", "Agent"),
    "membership": ("member_of", "Organisation"),
    "makers": ("made_by", "Organisation"),
}
"""Fact → its relation in memory, and the type of the node at the other end. Except the birthday, all other facts are only in the file."""


async def settle(life: Life, memory: Memory) -> Node:
    """Update the agent's node in memory to match the life file. Memory keeps facts that the file does not mention.

    All changes are in one transaction, because each transaction waits for the disk, and the first call adds many nodes.

    Raises:
        PlatformError: Memory failed.
    """
    node, changed = await memory.together(lambda graph: _settle(life, graph))
    if changed:
        await memory.tidy()
    return node


def _settle(life: Life, graph: Graph) -> tuple[Node, bool]:
    """Update the agent's node; return the node, and whether something has changed."""
    node = graph.ensure("Robot", {"name": life.name})
    changed = False
    if life.born is not None and node.get("born") != life.born:
        node, changed = graph.update(node, {"born": life.born}), True
    known = graph.relations(node)
    for fact, (relation, type) in RELATIONS.items():
        if fact not in life.facts:
            continue
        wanted = list(dict.fromkeys(texts(life.facts[fact])))
        there = [one.target for one in known if one.name == relation and one.source == node]
        for other in there:
            if other.get("name") not in wanted:
                changed = True
                graph.unrelate(node, relation, other)
        for text in wanted:
            if text not in [other.get("name") for other in there]:
                changed = True
                graph.relate(node, relation, graph.ensure(type, {"name": text}), {})
    return node, changed


async def recall(life: Life, memory: Memory) -> Mapping[str, Fact]:
    """Return the agent's facts. The birthday and the facts in `RELATIONS` come from memory, all others from the file.

    If memory has no node for the agent, all facts come from the file.

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
        names = [str(one.target.get("name", "")) for one in known if one.name == relation and one.source == node]
        before = texts(facts.get(fact, ()))
        order = {name: place for place, name in enumerate(before)}  # the file's order; new values come last
        facts[fact] = tuple(sorted(filter(None, names), key=lambda name: order.get(name, len(order))))
    return facts


def texts(fact: Fact) -> tuple[str, ...]:
    """Return the texts of a fact. If it consists of pairs, return the first text of each pair."""
    if isinstance(fact, str):
        return (fact,)
    return tuple(part if isinstance(part, str) else part[0] for part in fact)
