"""The legend below the picture: the whole notation, in the order of the paper's table."""

from __future__ import annotations

from dataclasses import dataclass

from ravestate.policy.diagram.layout import Box
from ravestate.policy.diagram.notation import EDGES, NODES
from ravestate.policy.diagram.shapes import line, number, outline
from ravestate.policy.diagram.sizes import SMALL
from ravestate.policy.diagram.text import width

__all__ = ["NARROWEST", "Legend", "legend"]

NARROWEST = 560.0
"""Pixels that a legend may use even below a narrower picture."""

_ROW = 26.0
_GAP = 20.0
_SAMPLE = {"slot": 30.0, "signal": 30.0, "rule": 30.0, "and": 18.0, "or": 18.0}
_EDGE = 38.0


@dataclass(frozen=True, slots=True)
class Legend:
    """SVG elements, with their width and height in pixels."""

    elements: str
    width: float
    height: float


def legend(x: float, y: float, room: float, prefix: str) -> Legend:
    """Draw the legend from (x, y) on, in rows of at most `room` pixels."""
    at, row, widest = 0.0, 0, 0.0
    found: list[str] = []
    entries = [(kind, words, _SAMPLE[kind]) for kind, words in NODES.items() if kind not in ("and", "or")]
    samples: list[tuple[str, str, float]] = [
        *entries,
        *((kind, words, _EDGE) for kind, words in EDGES.items()),
        *((kind, NODES[kind], _SAMPLE[kind]) for kind in ("and", "or")),
    ]
    for kind, words, sample in samples:
        whole = sample + 7.0 + width(words, SMALL)
        if at > 0 and at + whole > room:
            at, row = 0.0, row + 1
        left, middle = x + at, y + row * _ROW + _ROW / 2
        found.append(
            f'<g>{_sample(kind, left, middle, sample, prefix)}<text class="srs-small" x="{number(left + sample + 7.0)}" y="{number(middle + 3.6)}">{words}</text></g>'
        )
        at += whole
        widest = max(widest, at)
        at += _GAP
    return Legend("".join(found), widest, (row + 1) * _ROW)


def _sample(kind: str, left: float, middle: float, wide: float, prefix: str) -> str:
    for node in NODES:
        if node == kind:
            high = 18.0
            return outline(node, Box(left, middle - high / 2, wide, high))
    for edge in EDGES:
        if edge == kind:
            return line(edge, ((left, middle), (left + wide, middle)), prefix)
    raise AssertionError(kind)
