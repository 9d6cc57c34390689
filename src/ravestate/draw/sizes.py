"""Sizes of nodes and labels. A node has two lines (module and name), or three with a note."""

from __future__ import annotations

from ravestate.draw.graph import JUNCTIONS, Node
from ravestate.draw.text import clean, shorten, width

NAME = 13.0  # the font size of a node's name, in pixels
SMALL = 10.5  # the font size of a node's module and note, in pixels
LABEL = 10.5  # the font size of an edge's label, in pixels
LONGEST = 250.0  # the maximum width of a text in pixels; a wider text is cut, and the tooltip shows the whole text
_JUNCTION = 22.0  # pixels: width and height of a junction


def shown(text: str, size: float) -> str:
    """Return a text for drawing: without control characters, shortened if too long."""
    return shorten(clean(text), size, LONGEST)


def node_size(node: Node) -> tuple[float, float]:
    """Return the width and height of a node in pixels."""
    if node.kind in JUNCTIONS:
        return (_JUNCTION, _JUNCTION)
    texts = ((node.label, NAME), (node.module, SMALL), (node.note, SMALL))
    widest = max(width(shown(text, size), size) for text, size in texts)
    height = 28.0 + (10.0 if node.module else 0.0) + (12.0 if node.note else 0.0)
    return (float(round(max(44.0, widest + 24.0))), height)


def label_size(label: str) -> tuple[float, float] | None:
    """Return the width and height of an edge's label in pixels, or ``None`` if it is empty."""
    return (float(round(width(shown(label, LABEL), LABEL) + 8.0)), 16.0) if label else None
