"""People in memory, with the values of topics as nodes and relations.

A fact has a *topic*, such as *home*, and *values*, such as *Ulm*.
"""

from __future__ import annotations

from collections.abc import Mapping

from ravestate.modules import ontology

from .told import Told
from .topics import NAME, TOPICS, about, in_order
from .wording import Facts, alike, among, same

REMARK = "has_told"
"""The relation from a person to their *free statements*, which belong to no topic: *Jonas plays the violin*."""
LEFT_OUT = 2
"""The minimum number of letters that a short form leaves out: *Mo* is short for *Mohammed*, but *Paul* is not short for
*Paula*."""
MOST = 200
"""The maximum number of free statements that memory keeps for a person."""


def named(graph: ontology.Graph, name: str) -> ontology.Node | None:
    """Return the person of this name. If there are several, take the one with the most relations, then the oldest.

    Return None if there is none.
    """
    people = namesakes(graph, name)
    return max(people, key=lambda person: len(graph.relations(person))) if len(people) > 1 else next(iter(people), None)


def namesakes(graph: ontology.Graph, name: str) -> list[ontology.Node]:
    """Return all people of this name, oldest first."""
    return graph.find("Person", {"name": name})


def candidates(graph: ontology.Graph, name: str) -> list[ontology.Node]:
    """Return the people about whom memory has facts, and who may have this name. Exact namesakes come first."""
    people = (person for person in graph.find("Person", {}) if may_be(name, person.get("name") or ""))
    return sorted((one for one in people if known(graph, one)), key=lambda person: not same(name, person["name"]))


def may_be(name: str, other: str) -> bool:
    """Return whether two names may be one person's: one is a short form of the other, or a part of it.

    Example:
        >>> may_be("Mo", "Mohammed"), may_be("Sinéad", "Sinéad O'Hara"), may_be("Paul", "Paula")
        (True, True, False)
    """
    shorter, longer = sorted((name.casefold(), other.casefold()), key=len)
    short = longer.startswith(shorter) and len(longer) - len(shorter) >= LEFT_OUT
    return bool(shorter) and (short or alike(name, [other]))


def has_talked(graph: ontology.Graph, person: ontology.Node) -> bool:
    """Return whether a person in memory has talked to the agent, and was not only mentioned by other people."""
    relations = graph.relations(person)
    return not relations or any(relation.source.id == person.id for relation in relations)


def known(graph: ontology.Graph, person: ontology.Node) -> dict[str, tuple[str, ...]]:
    """Return the values of a person by topic, in the order of the topics, without the name."""
    values = {topic: tuple(node["name"] for node in nodes) for topic, nodes in _related(graph, person).items()}
    for topic in TOPICS.values():
        if not topic.relation and topic.name != NAME and (value := person.get(topic.name)) is not None:
            values[topic.name] = (str(value),)
    return {topic: values[topic] for topic in in_order(values)}


def note(graph: ontology.Graph, person: ontology.Node, facts: Facts, once: Facts) -> None:
    """Save the facts about a person. Saving them twice is harmless.

    If a topic may have several values, keep the values that other rules have saved in the meantime.

    Args:
        graph: The memory.
        person: The person; their node is saved as well.
        facts: Values by topic.
        once: Values that earlier calls may have saved. This call removes such values if `facts` lacks them.
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
            ours = not (topic.many and values) or among(node["name"], once.get(name, ()))
            if ours and not among(node["name"], values):
                graph.unrelate(person, topic.relation, node, forget=True)
        for value in values:
            if among(value, [node["name"] for node in present]):
                continue
            # People are not their own friends. A sister and a brother with the same name are two people.
            alike = [one for one in related if one != name and TOPICS[one].relation == topic.relation and topic.role]
            others = [person, *(node for one in alike for node in related[one])]
            found = (node for node in graph.find(topic.type, {"name": value}) if node not in others)
            thing = next(found, None) or graph.save(ontology.Node(topic.type, {"name": value}))
            graph.relate(person, topic.relation, thing, {"role": name} if topic.role else {})
            related.setdefault(name, []).append(thing)


def remarks(graph: ontology.Graph, person: ontology.Node) -> dict[str, Told]:
    """Return the free statements of a person by key, oldest first."""
    return {one.key: one for one, _ in _remarks(graph, person)}


def _remarks(graph: ontology.Graph, person: ontology.Node) -> list[tuple[Told, ontology.Node]]:
    parts = ("subject", "verb", "object", "wording")
    nodes = graph.related(person, REMARK, back=False)
    name = person.get(NAME) or ""
    return [(Told(*(node.get(part) or "" for part in parts), by=name, at=node.get("said_at")), node) for node in nodes]


def note_remarks(graph: ontology.Graph, person: ontology.Node, told: Mapping[str, Told]) -> None:
    """Save the last `MOST` free statements in `told`, and remove the person's other free statements from memory."""
    present = {one.key: node for one, node in _remarks(graph, person)}
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


def _related(graph: ontology.Graph, person: ontology.Node) -> dict[str, list[ontology.Node]]:
    """Return the nodes that have a name and to which a person is related, by topic."""
    found: dict[str, list[ontology.Node]] = {}
    for relation in graph.relations(person):
        topic = about(relation.name, relation.properties.get("role"))
        if topic and relation.source.id == person.id and relation.target.get("name"):
            found.setdefault(topic, []).append(relation.target)
    return found
