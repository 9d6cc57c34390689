"""The operations on the graph, in Cypher. The writes of each operation are one transaction."""

from __future__ import annotations

from collections.abc import Callable, Container, Mapping, Sequence
from typing import Any, TypeVar

from ravestate.errors import RuleError

from .document import read_document, write_document
from .node import Node, Relation, Value
from .store import Raw, Store
from .types import Types

T = TypeVar("T")

AGENT = "Agent"
"""The type of people and robots. Forgetting a node does not remove a related person or robot if memory knows more
about them than their name."""


class Graph:
    """The operations on the graph in a store. Each operation checks its arguments against the types."""

    def __init__(self, store: Store, types: Types) -> None:
        self._store = store
        self._types = types

    def prepare(self) -> None:
        """Create the tables that the types need."""
        self._store.prepare(self._types)

    def together(self, operations: Callable[[Graph], T]) -> T:
        """Run several operations as one transaction: all take effect, or none."""
        with self._store.transaction():
            return operations(self)

    # ------------------------------------------------------------------------------------ nodes

    def save(self, node: Node, /, *, of: str | None = None) -> Node:
        """Set a node's properties in memory, and remove properties that are None. Other properties in memory stay.

        Args:
            node: The node to write.
            of: The type that the node must have; subtypes are allowed.

        Returns:
            The node with all of its properties in memory.
        """
        if of is not None and not self._types.is_a(node.type, of):
            raise RuleError(f"{node.id} is a {node.type}, not a {of}")
        return self._write(_known(node), self._types.stored(node.type, node.properties))

    def ensure(self, type: str, properties: Mapping[str, Value]) -> Node:
        """Return the oldest node of this type with these properties. If there is none, create one."""
        found = self.find(type, properties)
        return found[0] if found else self.save(Node(type, properties))

    def find(self, type: str, properties: Mapping[str, Value]) -> list[Node]:
        """Return all nodes of a type and its subtypes with these properties, oldest first."""
        wanted = self._types.stored(type, properties)
        return self._matching(self._types.subtypes(type), wanted)

    def get(self, id: str, /) -> Node | None:
        """Return the node with this id; None if memory does not have it."""
        label, _, _ = id.partition(":")
        if label not in self._types:
            return None
        found = self._nodes(f"MATCH (n:{self._label(label)} {{`id`: $id}}) RETURN n", {"id": id})
        return found[0] if found else None

    def update(self, node: Node, properties: Mapping[str, Value]) -> Node:
        """Set properties of a node that memory has; return the node as memory now has it."""
        values = self._types.stored(node.type, properties)
        with self._store.transaction():
            self._must_know(node)
            return self._write(node, values)

    def _write(self, node: Node, values: Mapping[str, Any]) -> Node:
        [[raw]] = self._store.write(
            f"MERGE (n:{self._label(node.type)} {{`id`: $id}}){_setting('n', values)} RETURN n",
            {"id": node.id, **_parameters(values)},
        )
        return Node(node.type, self._types.loaded(node.type, raw.values), node.id)

    # ------------------------------------------------------------------------------------ relations

    def relate(self, node: Node, relation: str, other: Node, properties: Mapping[str, Value]) -> None:
        """Relate two nodes that memory has, and set properties of the relation."""
        self._types.check_relation(node.type, relation, other.type)
        values = self._types.stored(relation, properties)
        with self._store.transaction():
            self._must_know(node)
            self._must_know(other)
            self._relate(node, relation, other, values)

    def unrelate(self, node: Node, relation: str, other: Node, /, *, forget: bool = False) -> None:
        """Remove a relation, if there is one.

        With `forget`, also forget `other`, unless it is still the target of a relation. A person or robot also stays if
        memory knows more about them than their name. The file still has the bytes of forgotten nodes until the next
        `purge`. Memory purges by itself as soon as it has nothing else to do.
        """
        self._types.check_relation(node.type, relation, other.type)
        with self._store.transaction():
            self._store.write(
                f"MATCH (a:{self._label(node.type)} {{`id`: $a}})-[r:{self._store.relation(relation)}]->"
                f"(b:{self._label(other.type)} {{`id`: $b}}) DELETE r",
                {"a": _known(node).id, "b": _known(other).id},
            )
            if forget and not self._is_wanted(other, ()) and not self._is_known_otherwise(other, node):
                self._forget(other)

    def related(self, node: Node, relation: str, /, *, back: bool = False) -> list[Node]:
        """Return the nodes to which `node` has this relation, oldest first.

        With `back`, return the nodes that have this relation to `node`.
        """
        self._types.check_end(node.type, relation, back=back)
        edge = f"[r:{self._store.relation(relation)}]"
        pattern = f"<-{edge}-" if back else f"-{edge}->"
        return self._nodes(
            f"MATCH (a:{self._label(node.type)} {{`id`: $id}}){pattern}(b) RETURN b", {"id": _known(node).id}
        )

    def relations(self, node: Node, /) -> list[Relation]:
        """Return all relations of a node: first the relations from the node, then the relations to the node."""
        found = [Relation(node, name, other, values) for name, values, other in self._ends(node, back=False)]
        found += [
            Relation(other, name, node, values)
            for name, values, other in self._ends(node, back=True)
            if other.id != node.id  # a relation from the node to itself is already in the list
        ]
        return found

    def _relate(self, node: Node, relation: str, other: Node, values: Mapping[str, Any]) -> None:
        self._store.write(
            f"MATCH (a:{self._label(node.type)} {{`id`: $a}}), (b:{self._label(other.type)} {{`id`: $b}}) "
            f"MERGE (a)-[r:{self._store.relation(relation)}]->(b){_setting('r', values)}",
            {"a": node.id, "b": other.id, **_parameters(values)},
        )

    def _ends(self, node: Node, *, back: bool) -> list[tuple[str, dict[str, Value], Node]]:
        """Return each declared relation from a node: its name, its properties, and the node at its other end.

        With `back`, return the relations to the node.
        """
        found: list[tuple[str, dict[str, Value], Node]] = []
        for relation, raw in self._edges(node, back=back):
            other = self._node(raw)
            if other is not None and relation.label in self._types.relations:
                found.append((relation.label, self._types.loaded(relation.label, relation.values), other))
        return sorted(found, key=lambda end: (end[0], _age(end[2])))

    def _edges(self, node: Node, *, back: bool) -> list[tuple[Raw, Raw]]:
        self._types.properties(node.type)  # this raises an error if there is no such type
        pattern = "<-[r]-" if back else "-[r]->"
        rows = self._store.read(
            f"MATCH (a:{self._label(node.type)} {{`id`: $id}}){pattern}(b) RETURN r, b", {"id": _known(node).id}
        )
        return [(row[0], row[1]) for row in rows]

    # ------------------------------------------------------------------------------------ merging and forgetting

    def merge(self, keep: Node, duplicate: Node, /) -> Node:
        """Merge two nodes: give `keep` the duplicate's relations, and the properties that `keep` lacks. Return `keep`.

        Raises:
            RuleError: The types do not fit: `keep` must have the duplicate's type or a subtype.
        """
        if keep.id == duplicate.id:
            raise RuleError(f"{keep.id} cannot be merged with itself")
        if not self._types.is_a(keep.type, duplicate.type):
            hint = "; merge them the other way round" if self._types.is_a(duplicate.type, keep.type) else ""
            problem = f"a {keep.type} is not a {duplicate.type}{hint}"
            raise RuleError(f"{keep.id} cannot take over the data of {duplicate.id}: {problem}")
        with self._store.transaction():
            kept, other = self._must_know(keep), self._must_know(duplicate)
            self._must_declare(other)
            for name, values, target in self._ends(other, back=False):
                if target.id != kept.id:
                    self._take_over(kept, name, kept if target.id == other.id else target, values)
            for name, values, source in self._ends(other, back=True):
                if source.id not in (other.id, kept.id):
                    self._take_over(source, name, kept, values)
            missing = {key: value for key, value in other.properties.items() if key not in kept.properties}
            self._remove(other)
            return self._write(kept, self._types.stored(kept.type, missing))

    def _take_over(self, source: Node, name: str, target: Node, values: Mapping[str, Value]) -> None:
        """Copy a relation to another pair of nodes. If this pair has the relation already, its present values stay."""
        ends = self._ends(source, back=False)
        present = next((had for known, had, end in ends if (known, end.id) == (name, target.id)), dict[str, Value]())
        self._relate(source, name, target, self._types.stored(name, {**values, **present}))

    def only_about(self, node: Node, /) -> list[Node]:
        """Return the nodes that `forget` would remove, `node` first; an empty list if memory does not have `node`."""
        start = self.get(node.id)
        if start is None:
            return []
        going = {start.id: start}
        reached = [start]
        for one in reached:  # the list grows during the loop
            for _, _, other in self._ends(one, back=False):
                if other.id not in going and not self._is_known_otherwise(other, start):
                    going[other.id] = other
                    reached.append(other)
        while staying := [one for one in going if one != start.id and self._is_wanted(going[one], going)]:
            for one in staying:
                del going[one]
        return list(going.values())

    def forget(self, node: Node, /) -> list[Node]:
        """Remove a node, its relations, and the nodes that only this node needs. The file keeps none of their bytes.

        A node needs the targets of its relations, and in turn their targets. A target is not removed if a remaining node
        has a relation to it. A person or robot also stays if memory knows more about them than their name.

        Returns:
            The removed nodes, `node` first; an empty list if memory does not have `node`.
        """
        with self._store.transaction():
            going = self._forget(node)
            if going:
                self._store.purge()
        return going

    def purge(self) -> None:
        """Remove the bytes of forgotten nodes from the file now, instead of waiting until memory has nothing else to do."""
        self._store.purge()

    def _forget(self, node: Node) -> list[Node]:
        going = self.only_about(node)
        for one in going:
            self._remove(one)
        if going:
            self._store.note_bytes()
        return going

    def _is_known_otherwise(self, other: Node, start: Node) -> bool:
        """Return whether `other` is a person or robot with more in memory than a name and a relation to `start`."""
        if AGENT not in self._types or not self._types.is_a(other.type, AGENT):
            return False
        return bool(other.properties.keys() - {"name"}) or any(
            raw.values.get("id") != start.id for _, raw in self._edges(other, back=False)
        )

    def _is_wanted(self, node: Node, going: Container[object]) -> bool:
        """Return whether a node that stays (it is not in `going`) has a relation to `node`."""
        return any(raw.values.get("id") not in going for _, raw in self._edges(node, back=True))

    def _must_declare(self, node: Node) -> None:
        """Refuse a node with undeclared relations: they would be lost if the node were removed."""
        edges = self._edges(node, back=False) + self._edges(node, back=True)
        unknown = {relation.label for relation, _ in edges} - self._types.relations.keys()
        unknown |= {raw.label for _, raw in edges if raw.label not in self._types}
        if unknown:
            raise RuleError(
                f"{node.id} is related by {', '.join(sorted(unknown))}, which no file of types declares: add the missing file to "
                "the setting ontology.types"
            )

    def _remove(self, node: Node) -> None:
        self._store.write(f"MATCH (n:{self._label(node.type)} {{`id`: $id}}) DETACH DELETE n", {"id": node.id})

    # ------------------------------------------------------------------------------------ documents

    def tidy(self) -> None:
        """Move the log of writes into the database: after many writes, this frees main memory."""
        self._store.tidy()

    def export(self) -> dict[str, Any]:
        """Return all nodes and relations of declared types as a document for JSON, which `load` reads."""
        nodes = self._matching(tuple(self._types), {})
        known = {node.id for node in nodes}
        relations = [
            Relation(node, name, other, values)
            for node in nodes
            for name, values, other in self._ends(node, back=False)
            if other.id in known
        ]
        return write_document(nodes, relations)

    def load(self, document: Mapping[str, Any], /) -> int:
        """Save all nodes and relations of an exported document, or none of them; return the number of nodes."""
        nodes, relations = read_document(document, self._types)
        with self._store.transaction():
            for node in nodes:
                self.save(node)
            for one in relations:
                self.relate(one.source, one.name, one.target, one.properties)
        return len(nodes)

    def undeclared(self) -> list[str]:
        """Return the names of the types that have nodes in memory, but that no file of types declares."""
        return self._store.undeclared(self._types)

    # ------------------------------------------------------------------------------------ internals

    def _label(self, type: str) -> str:
        return self._store.labels((type,))

    def _matching(self, types: Sequence[str], wanted: Mapping[str, Any]) -> list[Node]:
        """Return the nodes of some types with these stored properties, oldest first."""
        starts = " OR ".join(f"n.`id` STARTS WITH '{type}:'" for type in types)
        tests = [f"({starts})"]
        tests += [f"n.`{key}` IS NULL" if wanted[key] is None else f"n.`{key}` = $p_{key}" for key in wanted]
        return self._nodes(
            f"MATCH (n:{self._store.labels(types)}) WHERE {' AND '.join(tests)} RETURN n",
            _parameters({key: value for key, value in wanted.items() if value is not None}),
        )

    def _nodes(self, statement: str, parameters: Mapping[str, Any]) -> list[Node]:
        """Return the nodes that a statement finds, each node once, oldest first."""
        rows = self._store.read(statement, parameters)
        found = {node.id: node for row in rows if (node := self._node(row[0])) is not None}
        return sorted(found.values(), key=_age)

    def _node(self, raw: Raw) -> Node | None:
        """Return the node that a raw node stands for, with its declared properties.

        Return None if its type is undeclared, or if its id is damaged.
        """
        id = raw.values.get("id")
        if raw.label not in self._types or not isinstance(id, str) or not id.startswith(f"{raw.label}:"):
            return None
        return Node(raw.label, self._types.loaded(raw.label, raw.values), id)

    def _must_know(self, node: Node) -> Node:
        self._types.properties(node.type)
        found = self.get(_known(node).id)
        if found is None:
            raise RuleError(
                f"memory does not know {node.id}, or has forgotten it: save it first, with await memory.save(node)"
            )
        return found


def _known(node: Node) -> Node:
    """Return the node if its id begins with its type, as `get` requires; refuse any other node."""
    if not node.id.startswith(f"{node.type}:"):
        raise RuleError(f"the id {node.id!r} of a {node.type} must begin with '{node.type}:'")
    return node


def _age(node: Node) -> tuple[str, str]:
    return node.id.partition(":")[2], node.id


def _setting(variable: str, values: Mapping[str, Any]) -> str:
    """Return the Cypher clause that sets properties. Its parameters begin with ``p_``; parameters for ids do not."""
    settings = ", ".join(f"{variable}.`{key}` = $p_{key}" for key in values)
    return f" SET {settings}" if settings else ""


def _parameters(values: Mapping[str, Any]) -> dict[str, Any]:
    return {f"p_{key}": value for key, value in values.items()}
