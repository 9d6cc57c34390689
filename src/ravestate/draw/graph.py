"""The diagram as a value: nodes and edges, without coordinates or colours."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

NodeKind = Literal["slot", "signal", "rule", "module", "and", "or"]
EdgeKind = Literal["reads", "writes", "emits", "emits_detached", "condition", "condition_detached"]


@dataclass(frozen=True, slots=True)
class Node:
    """A slot, a signal, a rule, a folded module, or the junction of a conjunction or disjunction.

    Attributes:
        id: The node's unique name within the diagram.
        kind: The node's kind.
        label: The text inside the node; empty for a junction.
        module: The module that declares the slot, signal or rule; empty for a junction and for a module.
        note: Options such as a weight, or the number of rules of a module; may be empty.
    """

    id: str
    kind: NodeKind
    label: str = ""
    module: str = ""
    note: str = ""

    @property
    def name(self) -> str:
        """The qualified name, ``module:label``."""
        return f"{self.module}:{self.label}" if self.module else self.label


@dataclass(frozen=True, slots=True)
class Edge:
    """An arrow between two nodes, which are given by their ids. The label may be empty."""

    source: str
    target: str
    kind: EdgeKind
    label: str = ""


@dataclass(frozen=True, slots=True)
class Diagram:
    """The nodes and edges of a picture, in declaration order.

    Raises:
        ValueError: Two nodes share an id, an edge has an unknown end, or an edge joins a node to itself.
    """

    nodes: tuple[Node, ...]
    edges: tuple[Edge, ...]

    def __post_init__(self) -> None:
        ids: set[str] = set()
        for node in self.nodes:
            if node.id in ids:
                raise ValueError(f"two nodes of a diagram share the id {node.id!r}")
            ids.add(node.id)
        for edge in self.edges:
            for end in (edge.source, edge.target):
                if end not in ids:
                    raise ValueError(f"{edge} ends at {end!r}, which is not a node of the diagram")
            if edge.source == edge.target:
                raise ValueError(f"{edge} ends where it began")


NODES: dict[NodeKind, str] = {
    "slot": "slot",
    "signal": "signal",
    "rule": "rule",
    "module": "module",
    "and": "conjunction",
    "or": "disjunction",
}
"""Kind of node → its name in the notation."""

EDGES: dict[EdgeKind, str] = {
    "reads": "reads",
    "writes": "writes",
    "emits": "emits",
    "emits_detached": "emits detached",
    "condition": "condition",
    "condition_detached": "detached condition",
}
"""Kind of edge → its name in the notation."""

JUNCTIONS: dict[NodeKind, str] = {"and": "∧", "or": "∨"}
"""Kind of junction → the sign inside it."""


def describe(node: Node) -> str:
    """Return a node's kind, name and note, for example ``rule hello:greet (×1.2)`` or ``conjunction``."""
    words = NODES[node.kind]
    if node.name:
        words += f" {node.name}"
    return f"{words} ({node.note})" if node.note else words


def used(diagram: Diagram) -> tuple[list[NodeKind], list[EdgeKind]]:
    """Return the kinds of nodes and the kinds of edges that a diagram uses, in the order of `NODES` and `EDGES`."""
    nodes = {node.kind for node in diagram.nodes}
    edges = {edge.kind for edge in diagram.edges}
    return [kind for kind in NODES if kind in nodes], [kind for kind in EDGES if kind in edges]
