"""Edge routing: the lines between vertices, as lists of points. The y coordinate of each vertex is known.

A line that is not straight turns on a track: one of several vertical lines between two layers (`tracks`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from ravestate.draw.layered import Chain, LayeredGraph
from ravestate.draw.tracks import Segment, tracks

Point = tuple[float, float]

_BEFORE = 12.0  # pixels from a layer to the first track
_PITCH = 8.0  # pixels between tracks
_AFTER = 20.0  # pixels from the last track to the next layer: room for the head of an arrow
_LEVEL = 0.01  # pixels: two coordinates that differ by less are equal


@dataclass(frozen=True, slots=True)
class Routed:
    """The middle of each vertex, the line of each link (edge) from its left to its right end, and the picture's width."""

    middles: list[Point]
    lines: list[list[Point]]
    width: float


def route(graph: LayeredGraph, middle: Sequence[float]) -> Routed:
    """Put the layers side by side, with room for the lines between them, and find the route of each line.

    `middle` has the y coordinate of each vertex's middle (pixels).
    """
    gaps: list[list[int]] = [[] for _ in graph.order]
    for number in range(len(graph.segments)):
        gaps[graph.layer[graph.ends(number)[0]]].append(number)
    across = [0.0] * len(graph.layer)
    # segment → two x coordinates: where its line leaves the y of its left end, and where it reaches the y of its right
    # end
    turns = [(0.0, 0.0)] * len(graph.segments)
    x = 0.0
    for layer, numbers in zip(graph.order, gaps, strict=True):
        column = max(graph.width[v] for v in layer)
        for v in layer:
            across[v] = x + column / 2
        x += column
        if numbers:
            found = tracks([_segment(graph, middle, number) for number in numbers])
            last = x + _BEFORE + max(0, found.count - 1) * _PITCH
            for number, track in zip(numbers, found.of, strict=True):
                turn = x + _BEFORE + (track or 0) * _PITCH
                turns[number] = (x + _BEFORE / 3, last + _AFTER / 4) if track is None else (turn, turn)
            x = last + _AFTER
    return Routed(
        [(across[v], middle[v]) for v in range(len(middle))],
        [_line(graph, chain, across, middle, turns) for chain in graph.chains],
        x,
    )


def _segment(graph: LayeredGraph, middle: Sequence[float], number: int) -> Segment:
    low, high = graph.segments[number]
    p, q = graph.ports[low], graph.ports[high]
    return (low, high, middle[p.vertex] + p.offset, middle[q.vertex] + q.offset)


def _line(
    graph: LayeredGraph, chain: Chain, across: Sequence[float], middle: Sequence[float], turns: Sequence[Point]
) -> list[Point]:
    points: list[Point] = []
    for number in chain:
        low, high, y, z = _segment(graph, middle, number)
        u, v = graph.ports[low].vertex, graph.ports[high].vertex
        leaves, reaches = turns[number]
        points += [(across[u] + graph.width[u] / 2, y), (leaves, y), (reaches, z), (across[v] - graph.width[v] / 2, z)]
    return _simple(points)


def _simple(points: Sequence[Point]) -> list[Point]:
    """Return the points without duplicates, and without those inside a straight horizontal piece."""
    found: list[Point] = []
    for point in points:
        if found and abs(found[-1][0] - point[0]) < _LEVEL and abs(found[-1][1] - point[1]) < _LEVEL:
            continue
        if len(found) > 1 and abs(found[-2][1] - point[1]) < _LEVEL and abs(found[-1][1] - point[1]) < _LEVEL:
            found.pop()
        found.append(point)
    return found
