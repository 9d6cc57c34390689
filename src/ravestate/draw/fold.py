"""Folding: a whole module becomes one node of the diagram."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection

from ravestate.draw.graph import Diagram, Edge, EdgeKind, Node

_STRONGEST_FIRST: tuple[EdgeKind, ...] = (
    "writes",
    "emits",
    "condition",
    "emits_detached",
    "condition_detached",
    "reads",
)


def fold(diagram: Diagram, unfolded: Collection[str] = ()) -> Diagram:
    """Return the diagram with one node for each module that is not `unfolded`.

    Edges inside a folded module disappear. Several edges from one node to another become one arrow of the strongest
    kind, if one of the nodes is a folded module.
    """
    home = _modules(diagram)
    rules = Counter(home[node.id] for node in diagram.nodes if node.kind == "rule")
    places = {node.id: node.id if home[node.id] in unfolded else f"module {home[node.id]}" for node in diagram.nodes}
    nodes: dict[str, Node] = {}
    for node in diagram.nodes:
        place, module = places[node.id], home[node.id]
        if place == node.id:
            nodes[place] = node
        else:
            note = f"{rules[module] or 'no'} rule{'' if rules[module] == 1 else 's'}"
            nodes.setdefault(place, Node(place, "module", module, "", note))
    edges: dict[object, Edge] = {}
    for edge in diagram.edges:
        source, target = places[edge.source], places[edge.target]
        if source == edge.source and target == edge.target:
            edges[edge] = edge
        elif source != target:
            found = edges.setdefault((source, target), Edge(source, target, edge.kind))
            if _STRONGEST_FIRST.index(edge.kind) < _STRONGEST_FIRST.index(found.kind):
                edges[source, target] = Edge(source, target, edge.kind)
    return Diagram(tuple(nodes.values()), tuple(edges.values()))


def _modules(diagram: Diagram) -> dict[str, str]:
    """Return a mapping from each node's id to its module. A junction belongs to the module of its rule."""
    home = {node.id: node.module for node in diagram.nodes}
    leads = {edge.source: edge.target for edge in diagram.edges if edge.kind.startswith("condition")}
    kinds = {node.id: node.kind for node in diagram.nodes}
    for node in diagram.nodes:
        end = node.id
        while kinds[end] in ("and", "or"):
            end = leads[end]
        home[node.id] = home[end]
    return home
