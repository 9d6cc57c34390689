"""The legend below the picture: a sample of each kind of node and edge that the picture has."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial

from ravestate.draw.graph import EDGES, JUNCTIONS, NODES, Diagram, EdgeKind, NodeKind, used
from ravestate.draw.layout import Box
from ravestate.draw.shapes import line, number, outline
from ravestate.draw.text import SMALL, width

NARROWEST = 560.0  # the width in pixels that a legend may use even if the picture is narrower
_ROW = 26.0  # pixels: height of a row
_GAP = 20.0  # pixels between entries
_SAMPLE: dict[NodeKind, float] = {kind: 18.0 if kind in JUNCTIONS else 30.0 for kind in NODES}
"""Kind of node → the width of its sample (pixels)."""
_HIGH = 18.0  # pixels: height of a sample node
_EDGE = 38.0  # pixels: length of a sample edge
_TEXT = 7.0  # pixels from a sample to its text


@dataclass(frozen=True, slots=True)
class Legend:
    """The SVG elements of a legend, with their total width and height in pixels."""

    elements: str
    width: float
    height: float


def legend(diagram: Diagram, x: float, y: float, room: float, prefix: str) -> Legend:
    """Return the legend of a diagram, in rows of at most `room` pixels.

    The legend's upper left corner is at (x, y) (pixels). The ids of the arrowheads begin with `prefix` (see `heads`).
    """
    nodes, edges = used(diagram)
    plain: list[NodeKind] = [kind for kind in nodes if kind not in JUNCTIONS]
    junctions: list[NodeKind] = [kind for kind in nodes if kind in JUNCTIONS]
    entries = [
        *((NODES[kind], _SAMPLE[kind], partial(_node, kind)) for kind in plain),
        *((EDGES[kind], _EDGE, partial(_edge, kind, prefix)) for kind in edges),
        *((NODES[kind], _SAMPLE[kind], partial(_node, kind)) for kind in junctions),
    ]
    if not entries:
        return Legend("", 0.0, 0.0)
    wide = [sample + _TEXT + width(words, SMALL) for words, sample, _ in entries]
    places = _rows(wide, room)
    found: list[str] = []
    for (words, sample, draw), (at, row) in zip(entries, places, strict=True):
        left, middle = x + at, y + row * _ROW + _ROW / 2
        found.append(
            f'<g>{draw(left, middle)}<text class="srs-small" x="{number(left + sample + _TEXT)}" '
            f'y="{number(middle + 3.6)}">{words}</text></g>'
        )
    widest = max(at + whole for (at, _), whole in zip(places, wide, strict=True))
    return Legend("".join(found), widest, (places[-1][1] + 1) * _ROW)


def _rows(wide: Sequence[float], room: float) -> list[tuple[float, int]]:
    """Return the left edge (pixels) and the row of each entry. The rows are few and about equally long."""
    found = _filled(wide, room)
    while room > max(wide) and (narrower := _filled(wide, room - 10.0))[-1][1] == found[-1][1]:
        found, room = narrower, room - 10.0
    return found


def _filled(wide: Sequence[float], room: float) -> list[tuple[float, int]]:
    found: list[tuple[float, int]] = []
    at, row = 0.0, 0
    for whole in wide:
        if at > 0 and at + whole > room:
            at, row = 0.0, row + 1
        found.append((at, row))
        at += whole + _GAP
    return found


def _node(kind: NodeKind, left: float, middle: float) -> str:
    return outline(kind, Box(left, middle - _HIGH / 2, _SAMPLE[kind], _HIGH))


def _edge(kind: EdgeKind, prefix: str, left: float, middle: float) -> str:
    return line(kind, ((left, middle), (left + _EDGE, middle)), prefix)
