"""Coordinate assignment: it first makes lines short, and then makes them straight.

In one layer after the other, the vertices move as near as possible to their neighbours. Within one layer, a weighted
isotonic regression (pool adjacent violators) finds the best coordinates that keep the minimum gaps. Forward and backward
sweeps repeat this for all layers. In the end, `Straightener` removes small steps.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from math import inf

from ravestate.draw.layered import LayeredGraph
from ravestate.draw.straighten import Straightener

_SWEEPS = 24  # sweeps over all layers, forwards and backwards in turn
# The weight of neighbours that a sweep has not reached yet, relative to neighbours that it has passed. It holds only in
# the first half of the sweeps; later, all neighbours have equal weight.
_AHEAD = 0.15


def assign_coordinates(graph: LayeredGraph, room: float | None = None) -> list[float]:
    """Return the y coordinate of each vertex's middle in pixels. The graph must have ordered layers and placed ports.

    Ports are the points where lines touch a vertex. The picture is at most `room` pixels high, unless its largest layer
    needs more.
    """
    gaps: list[list[float]] = []
    middle = [0.0] * len(graph.layer)
    for layer in graph.order:
        gaps.append([graph.separation(u, v) for u, v in pairwise(layer)])
        y = -sum(gaps[-1]) / 2
        for v, gap in zip(layer, [*gaps[-1], 0.0], strict=True):
            middle[v] = y
            y += gap
    # vertex → (neighbour, offset between the ports, weight)
    before: list[list[tuple[int, float, float]]] = [[] for _ in middle]
    after: list[list[tuple[int, float, float]]] = [[] for _ in middle]
    for low, high in graph.segments:
        p, q = graph.ports[low], graph.ports[high]
        weight = (1.0, 2.0, 8.0)[(graph.kind[p.vertex] == "dummy") + (graph.kind[q.vertex] == "dummy")]
        after[p.vertex].append((q.vertex, q.offset - p.offset, weight))
        before[q.vertex].append((p.vertex, p.offset - q.offset, weight))
    half = inf if room is None else max(room, *(sum(apart) for apart in gaps)) / 2
    for sweep in range(_SWEEPS):
        forward = sweep % 2 == 0
        ahead = 1.0 if sweep >= _SWEEPS // 2 else _AHEAD
        for at in range(len(graph.order)) if forward else range(len(graph.order) - 1, -1, -1):
            layer = graph.order[at]
            wishes: list[float] = []
            weights: list[float] = []
            for v in layer:
                pulls = [(w, offset, weight * (1.0 if forward else ahead)) for w, offset, weight in before[v]]
                pulls += [(w, offset, weight * (ahead if forward else 1.0)) for w, offset, weight in after[v]]
                total = sum(weight for _, _, weight in pulls)
                wishes.append(
                    sum((middle[w] + offset) * weight for w, offset, weight in pulls) / total if pulls else middle[v]
                )
                weights.append(total if pulls else 0.01)
            for v, y in zip(layer, _isotonic(wishes, weights, gaps[at], half), strict=True):
                middle[v] = y
    Straightener(graph, middle).run()
    return middle


def _isotonic(wishes: Sequence[float], weights: Sequence[float], gaps: Sequence[float], half: float) -> list[float]:
    """Return coordinates that keep the gaps and are nearest to `wishes` (weighted least squares).

    The coordinates are between -`half` and `half` (pixels). `half` is half of the height that the picture may have.
    """
    pools: list[tuple[float, float, int]] = []  # (mean, weight, number of members)
    offsets: list[float] = []
    offset = 0.0
    for i, (wish, weight) in enumerate(zip(wishes, weights, strict=True)):
        offsets.append(offset)
        mean, heavy, many = wish - offset, weight, 1
        while pools and pools[-1][0] >= mean:
            other, weigh, more = pools.pop()
            mean = (mean * heavy + other * weigh) / (heavy + weigh)
            heavy += weigh
            many += more
        pools.append((mean, heavy, many))
        offset += gaps[i] if i < len(gaps) else 0.0
    highest = half - sum(gaps)
    means = [max(-half, min(highest, mean)) for mean, _, many in pools for _ in range(many)]
    return [mean + offset for mean, offset in zip(means, offsets, strict=True)]
