"""Coordinate assignment: the best of several methods.

Brandes and Köpf's alignment suits small pictures, and relaxation (`relax`) suits crowded ones. Each candidate is
straightened. The candidate with the shortest lines and the fewest steps wins; among equal candidates, the first wins.
"""

from __future__ import annotations

from ravestate.draw.brandes_koepf import brandes_koepf
from ravestate.draw.layered import LayeredGraph
from ravestate.draw.relax import relax
from ravestate.draw.straighten import straighten

_STEP = 70.0  # the cost of a step in a line, in pixels of length
_SPREADS = (1.0, 1.15)  # factors on the minimum distances: one candidate of `relax` for each
_LEVEL = 0.01  # pixels: a smaller step counts as none


def assign_coordinates(graph: LayeredGraph, room: float | None = None) -> list[float]:
    """Return the vertical middle of each vertex in pixels.

    Args:
        graph: A graph with ordered layers and placed ports.
        room: The maximum height of the picture in pixels, unless its largest layer needs more; ``None`` for any height.
    """
    candidates = [relax(graph, spread, room) for spread in _SPREADS]
    if room is None:
        candidates.insert(0, brandes_koepf(graph))
    for candidate in candidates:
        straighten(graph, candidate)
    costs = [round(_cost(graph, candidate), 3) for candidate in candidates]
    return candidates[costs.index(min(costs))]


def _cost(graph: LayeredGraph, middle: list[float]) -> float:
    total = 0.0
    for low, high in graph.segments:
        p, q = graph.ports[low], graph.ports[high]
        step = abs(middle[p.vertex] + p.offset - middle[q.vertex] - q.offset)
        if step > _LEVEL:
            total += step + _STEP
    return total
