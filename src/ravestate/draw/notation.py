"""The words of the notation, in the order of the paper's table (section *Signal-Rule-Slot Diagrams*)."""

from __future__ import annotations

from ravestate.draw.graph import Diagram, EdgeKind, Node, NodeKind

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
    """Return a node's kind, name and note: ``rule hello:greet (×1.2)``, or ``conjunction``."""
    words = NODES[node.kind]
    if node.name:
        words += f" {node.name}"
    return f"{words} ({node.note})" if node.note else words


def used(diagram: Diagram) -> tuple[list[NodeKind], list[EdgeKind]]:
    """Return the kinds of nodes and the kinds of edges that a diagram uses, in the order of the paper's table."""
    nodes = {node.kind for node in diagram.nodes}
    edges = {edge.kind for edge in diagram.edges}
    return [kind for kind in NODES if kind in nodes], [kind for kind in EDGES if kind in edges]
