"""The Signal-Rule-Slot diagram laid out as data, with modules folded to one node each, or unfolded.

The page only draws it: places, lines and sizes are from the layout of ``ravestate.draw``.
"""

from __future__ import annotations

from collections.abc import Collection
from typing import Any

from ravestate.draw.fold import fold
from ravestate.draw.graph import Diagram
from ravestate.draw.layout import lay_out
from ravestate.draw.sizes import label_size, node_size

__all__ = ["draw"]


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
                "kind": node.kind,
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
