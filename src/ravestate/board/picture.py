"""The layout of the Signal-Rule-Slot diagram, as a frame for the page."""

from __future__ import annotations

from collections.abc import Sequence

from ravestate.board.protocol import Drawing, DrawnEdge, DrawnNode
from ravestate.draw.fold import fold
from ravestate.draw.graph import Diagram
from ravestate.draw.layout import lay_out
from ravestate.draw.sizes import label_size, node_size


def draw(diagram: Diagram, unfolded: Sequence[str]) -> Drawing:
    """Lay out a diagram with some modules unfolded. Hundreds of nodes take a second or so."""
    folded = fold(diagram, frozenset(unfolded))
    sizes = {node.id: node_size(node) for node in folded.nodes}
    layout = lay_out(folded, sizes, [label_size(edge.label) for edge in folded.edges])
    nodes = [
        DrawnNode(node.id, node.kind, node.label, node.module, node.note, (box.x, box.y, box.width, box.height))
        for node in folded.nodes
        if (box := layout.boxes[node.id])
    ]
    edges = [
        DrawnEdge(
            edge.source,
            edge.target,
            edge.kind,
            edge.label,
            list(points),
            None if box is None else (box.x, box.y, box.width, box.height),
        )
        for edge, points, box in zip(folded.edges, layout.lines, layout.labels, strict=True)
    ]
    return Drawing(list(unfolded), layout.width, layout.height, nodes, edges)
