"""What memory has of people, in terms of topics."""

from __future__ import annotations

from collections.abc import Mapping

from ravestate.modules import ontology

from .topics import NAME, TOPICS, Topic
from .wording import same

__all__ = ["known", "named", "note"]


async def named(memory: ontology.Memory, name: str) -> ontology.Node | None:
    """The person of this name; of several the one of whom most is known, of these the oldest."""
    people = await memory.find("Person", name=name)
    if len(people) < 2:
        return people[0] if people else None
    amounts = [len(await memory.relations(person)) for person in people]
    return people[amounts.index(max(amounts))]


async def known(memory: ontology.Memory, person: ontology.Node) -> dict[str, tuple[str, ...]]:
    """What is known of a person: values by topic, in the order of the topics. The name is not among them."""
    found = await _related(memory, person)
    return {
        topic.name: tuple(node["name"] for node in found[topic.relation])
        for topic in TOPICS.values()
        if topic.relation in found
    }


async def note(memory: ontology.Memory, person: ontology.Node, facts: Mapping[str, tuple[str, ...]]) -> None:
    """Write down what is known of a person. Whatever else memory has under these topics is taken away.

    To do it twice does no harm.

    Args:
        memory: Where to.
        person: Of whom; he is saved as well.
        facts: Values by topic.
    """
    await memory.save(person)
    before = await _related(memory, person)
    for name, values in facts.items():
        topic = TOPICS[name]
        if name == NAME:
            continue
        present = before.get(topic.relation, [])
        for node in present:
            if not any(same(node["name"], value) for value in values):
                await memory.unrelate(person, topic.relation, node)
        for value in values:
            if not any(same(node["name"], value) for node in present):
                await memory.relate(person, topic.relation, await _thing(memory, topic, value, person))


async def _related(memory: ontology.Memory, person: ontology.Node) -> dict[str, list[ontology.Node]]:
    """The named nodes to which a person is related, by relation."""
    found: dict[str, list[ontology.Node]] = {}
    for relation in await memory.relations(person):
        if relation.source.id == person.id and relation.target.get("name"):
            found.setdefault(relation.name, []).append(relation.target)
    return found


async def _thing(memory: ontology.Memory, topic: Topic, value: str, person: ontology.Node) -> ontology.Node:
    """The node that a value names; nobody is his own friend."""
    for node in await memory.find(topic.type, name=value):
        if node.id != person.id:
            return node
    return await memory.create(topic.type, name=value)
