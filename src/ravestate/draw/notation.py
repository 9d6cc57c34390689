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
"""The word for each kind of node."""

EDGES: dict[EdgeKind, str] = {
    "reads": "reads",
    "writes": "writes",
    "emits": "emits",
    "emits_detached": "emits detached",
    "condition": "condition",
    "condition_detached": "detached condition",
}
"""The words for each kind of edge."""

JUNCTIONS: dict[NodeKind, str] = {"and": "∧", "or": "∨"}
"""The sign inside a junction."""


def describe(node: Node) -> str:
    """Return the full name of a node: ``rule hello:greet (×1.2)``, or ``conjunction``."""
    words = NODES[node.kind]
    if node.name:
        words += f" {node.name}"
    return f"{words} ({node.note})" if node.note else words


def used(diagram: Diagram) -> tuple[list[NodeKind], list[EdgeKind]]:
    """Return the kinds of nodes and of edges of a diagram, in the order of the table, for its legend."""
    nodes = {node.kind for node in diagram.nodes}
    edges = {edge.kind for edge in diagram.edges}
    return [kind for kind in NODES if kind in nodes], [kind for kind in EDGES if kind in edges]
