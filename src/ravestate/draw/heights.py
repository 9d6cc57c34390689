"""How far down each vertex stands: the best of several ways.

Alignment (`coordinates`) suits small pictures, relaxation (`relax`) crowded ones. All candidates are
straightened; the one with the shortest lines and the fewest steps wins, the first among equals.
"""

from __future__ import annotations

from ravestate.draw.coordinates import middles
from ravestate.draw.layered import Layered
from ravestate.draw.relax import relaxed
from ravestate.draw.straighten import straighten

__all__ = ["heights"]

_STEP = 70.0  # pixels of length that a step is worth
_AIR = (1.0, 1.15)
_LEVEL = 0.01


def heights(graph: Layered, room: float | None = None) -> list[float]:
    """The vertical middle of each vertex of a graph in order, in pixels.

    Args:
        graph: Its layers are in order, and its ports are placed.
        room: How high the picture may be, in pixels, if its most crowded layer fits in there; ``None`` if that is open.
    """
    candidates = [relaxed(graph, air, room) for air in _AIR]
    if room is None:
        candidates.insert(0, middles(graph))
    for candidate in candidates:
        straighten(graph, candidate)
    costs = [round(_cost(graph, candidate), 3) for candidate in candidates]
    return candidates[costs.index(min(costs))]


def _cost(graph: Layered, middle: list[float]) -> float:
    total = 0.0
    for low, high in graph.segments:
        p, q = graph.ports[low], graph.ports[high]
        step = abs(middle[p.vertex] + p.offset - middle[q.vertex] - q.offset)
        if step > _LEVEL:
            total += step + _STEP
    return total
