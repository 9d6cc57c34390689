"""The Signal-Rule-Slot diagram laid out as data, with modules folded to one node each, or unfolded.

The page only draws it: places, lines and sizes are from the layout of ``ravestate.policy.diagram``.
"""

from __future__ import annotations

from collections.abc import Collection
from typing import Any

from ravestate.policy.diagram.graph import Diagram, Edge, Node
from ravestate.policy.diagram.layout import lay_out
from ravestate.policy.diagram.sizes import label_size, node_size

__all__ = ["MODULE", "draw", "fold"]

MODULE = "module "
"""What the id of a folded module begins with."""


def fold(diagram: Diagram, unfolded: Collection[str]) -> Diagram:
    """The diagram in which all modules but those that are unfolded are one node each.

    What goes on within a folded module is not drawn; edges of one kind between the same two nodes are one.

    Args:
        diagram: The whole.
        unfolded: Names of modules.

    Example:
        >>> whole = Diagram((Node("s", "slot", "s", "m"), Node("r", "rule", "r", "n")), (Edge("s", "r", "reads"),))
        >>> [node.id for node in fold(whole, {"n"}).nodes]
        ['module m', 'r']
    """
    home = _modules(diagram)
    places = {
        node.id: node.id if home[node.id] in unfolded else f"{MODULE}{home[node.id]}"
        for node in diagram.nodes
    }
    rules: dict[str, int] = {}
    for node in diagram.nodes:
        if node.kind == "rule":
            rules[home[node.id]] = rules.get(home[node.id], 0) + 1
    nodes: dict[str, Node] = {}
    for node in diagram.nodes:
        place = places[node.id]
        if place == node.id:
            nodes[place] = node
        else:
            count = rules.get(home[node.id], 0)
            note = f"{count} rule{'' if count == 1 else 's'}" if count else "no rules"
            nodes.setdefault(place, Node(place, "slot", home[node.id], "", note))
    edges: dict[Edge, None] = {}
    for edge in diagram.edges:
        source, target = places[edge.source], places[edge.target]
        if source == target:
            continue
        whole = source == edge.source and target == edge.target
        edges.setdefault(Edge(source, target, edge.kind, edge.label if whole else ""))
    return Diagram(tuple(nodes.values()), tuple(edges))


def draw(diagram: Diagram, unfolded: Collection[str]) -> dict[str, Any]:
    """Lay a diagram out, as plain data; lengths in pixels. Takes a second or so for hundreds of nodes.

    Returns:
        ``width``, ``height``; ``nodes``: each with ``id``, ``kind``, ``label``, ``module``, ``note`` and ``box`` (left,
        top, width, height); ``edges``: each with ``source``, ``target``, ``kind``, ``label``, ``points`` and ``box`` (of
        the label, or None).
    """
    folded = fold(diagram, unfolded)
    layout = lay_out(
        folded, {n.id: node_size(n) for n in folded.nodes}, [label_size(e.label) for e in folded.edges]
    )
    nodes: list[dict[str, Any]] = []
    for node in folded.nodes:
        box = layout.boxes[node.id]
        nodes.append(
            {
                "id": node.id,
                "kind": "module" if node.id.startswith(MODULE) else node.kind,
                "label": node.label,
                "module": node.module,
                "note": node.note,
                "box": [box.x, box.y, box.width, box.height],
            }
        )
    edges: list[dict[str, Any]] = []
    for edge, points, label in zip(folded.edges, layout.lines, layout.labels, strict=True):
        edges.append(
            {
                "source": edge.source,
                "target": edge.target,
                "kind": edge.kind,
                "label": edge.label,
                "points": [list(point) for point in points],
                "box": None if label is None else [label.x, label.y, label.width, label.height],
            }
        )
    return {"width": layout.width, "height": layout.height, "nodes": nodes, "edges": edges}


def _modules(diagram: Diagram) -> dict[str, str]:
    """The module of each node; a junction belongs to the rule that it leads to."""
    home = {node.id: node.module for node in diagram.nodes}
    leads = {edge.source: edge.target for edge in diagram.edges if edge.kind.startswith("condition")}
    kinds = {node.id: node.kind for node in diagram.nodes}
    for node in diagram.nodes:
        end = node.id
        while kinds[end] in ("and", "or"):
            end = leads[end]
        home[node.id] = home[end]
    return home
