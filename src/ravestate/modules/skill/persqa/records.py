"""People in memory: topics as nodes and relations."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from ravestate.modules import ontology

from .told import Told
from .topics import NAME, TOPICS, Topic, about, in_order
from .wording import among

REMARK = "has_told"
"""The relation from a person to what they told."""
MOST = 200
"""The number of remarks that memory keeps for a person."""


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


def remarks(graph: ontology.Graph, person: ontology.Node) -> dict[str, Told]:
    """Return what a person told that no topic covers, by key, oldest first."""
    found: dict[str, Told] = {}
    for node in graph.related(person, REMARK, back=False):
        parts = (node.get(name) or "" for name in ("subject", "verb", "object", "wording"))
        one = Told(*parts, by=person.get(NAME) or "", at=node.get("said_at"))
        found[one.key] = one
    return found


def note_remarks(graph: ontology.Graph, person: ontology.Node, told: Mapping[str, Told]) -> None:
    """Save what a person told, at most the last `MOST` remarks; those not in `told` are removed."""
    present = {
        f"{n.get('subject')} / {n.get('verb')} / {n.get('object') or ''}".lower(): n
        for n in graph.related(person, REMARK, back=False)
    }
    kept = dict(list(told.items())[-MOST:])
    for key, node in present.items():
        if key not in kept:
            graph.unrelate(person, REMARK, node, forget=True)
    for key, one in kept.items():
        if key not in present:
            values = {
                "subject": one.subject,
                "verb": one.verb,
                "object": one.object,
                "wording": one.text,
                "said_at": one.at,
            }
            node = graph.save(ontology.Node("Remark", {name: value for name, value in values.items() if value}))
            graph.relate(person, REMARK, node, {})


def namesakes(graph: ontology.Graph, name: str) -> list[ontology.Node]:
    """Return all people of this name, oldest first."""
    return graph.find("Person", {"name": name})


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
