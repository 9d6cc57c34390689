"""People in memory: topics as nodes and relations."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from ravestate.modules import ontology

from .topics import NAME, TOPICS, Topic, about, in_order
from .wording import among


def named(graph: ontology.Graph, name: str) -> ontology.Node | None:
    """Return the person with this name. If there are several, prefer the one with the most relations, then the
    oldest."""
    people = graph.find("Person", {"name": name})
    if len(people) < 2:
        return people[0] if people else None
    amounts = [len(graph.relations(person)) for person in people]
    return people[amounts.index(max(amounts))]


def known(graph: ontology.Graph, person: ontology.Node) -> dict[str, tuple[str, ...]]:
    """Return the values of a person by topic, in the order of the topics, without the name."""
    found = _related(graph, person)
    values = {topic: tuple(node["name"] for node in nodes) for topic, nodes in found.items()}
    for topic in TOPICS.values():
        if not topic.relation and topic.name != NAME and (value := person.get(topic.name)) is not None:
            values[topic.name] = (str(value),)
    return {topic: values[topic] for topic in in_order(values)}


def note(
    graph: ontology.Graph,
    person: ontology.Node,
    facts: Mapping[str, tuple[str, ...]],
    once: Mapping[str, tuple[str, ...]],
) -> None:
    """Save the facts about a person. Saving them twice is harmless.

    If a topic may have several values, those that other rules have saved in the meantime stay.

    Args:
        graph: The memory.
        person: The person; their node is saved as well.
        facts: Values by topic.
        once: Values that earlier calls may have saved; those not in `facts` are removed.
    """
    graph.save(person)
    related = _related(graph, person)
    for name, values in facts.items():
        topic = TOPICS[name]
        if not topic.relation:
            graph.update(person, {name: int(values[0]) if values else None})
            continue
        present = related.get(name, [])
        for node in present:
            if among(node["name"], values):
                continue
            if not (topic.many and values) or among(node["name"], once.get(name, ())):
                graph.unrelate(person, topic.relation, node, forget=True)
        for value in values:
            if not among(value, [node["name"] for node in present]):
                others = [
                    node
                    for one, nodes in related.items()
                    if one != name and TOPICS[one].relation == topic.relation
                    for node in nodes
                ]
                thing = _thing(graph, topic, value, [person, *(others if topic.role else [])])
                graph.relate(person, topic.relation, thing, {"role": name} if topic.role else {})
                related.setdefault(name, []).append(thing)


def _related(graph: ontology.Graph, person: ontology.Node) -> dict[str, list[ontology.Node]]:
    """Return the named nodes to which a person is related, by topic."""
    found: dict[str, list[ontology.Node]] = {}
    for relation in graph.relations(person):
        topic = about(relation.name, relation.properties.get("role"))
        if topic and relation.source.id == person.id and relation.target.get("name"):
            found.setdefault(topic, []).append(relation.target)
    return found


def _thing(graph: ontology.Graph, topic: Topic, value: str, others: Sequence[ontology.Node]) -> ontology.Node:
    """Return the node that a value names, but none of the `others`: people are not their own friends."""
    for node in graph.find(topic.type, {"name": value}):
        if node not in others:
            return node
    return graph.save(ontology.Node(topic.type, {"name": value}))
