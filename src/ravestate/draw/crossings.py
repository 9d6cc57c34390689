"""Crossing minimisation: the order of the vertices within their layers.

Barycentre sweeps run forwards and backwards. After each sweep, adjacent vertices swap places if this saves crossings
(Sugiyama, Tagawa and Toda 1981; Gansner et al. 1993). There are two initial orders; the result is the best order found.
The initial orders come from a depth-first search in declaration order, which keeps related declarations together.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right, insort
from collections.abc import Sequence
from itertools import pairwise

from ravestate.draw.layered import LayeredGraph, places

_WORK = 400_000  # the maximum number of segments (lines between two neighbouring layers) times sweeps
_PATIENCE = 4  # the search ends after this many sweeps without improvement


def minimise_crossings(graph: LayeredGraph, *, centred: bool = False) -> None:
    """Reorder the layers of `graph` in place.

    A vertex's neighbours are initially in order of creation. If `centred`, the dummies among them (vertices at which a
    long edge passes a layer) are in the middle. Long edges that share their dummies then run straight through many
    layers, with branches to both sides.
    """
    before, after = graph.neighbours()
    if centred:
        before = [_dummies_centred(graph, vertices) for vertices in before]
        after = [_dummies_centred(graph, vertices) for vertices in after]
    sweeps = max(4, min(24, _WORK // (1 + len(graph.segments))))
    best = graph.order
    # An order with as many crossings as the order of creation still replaces that order, because of the + 1.
    least = count_crossings(best, after) + 1
    for downwards in (True, False):
        order, crossed = _sweep(_start(graph, before, after, downwards), before, after, sweeps)
        if crossed < least:
            best, least = order, crossed
        if not least:
            break
    graph.order = best


def count_crossings(order: Sequence[Sequence[int]], after: Sequence[Sequence[int]]) -> int:
    """Return the number of crossing pairs of segments; `after` has each vertex's neighbours in the next layer."""
    total = 0
    for layer, following in pairwise(order):
        place = {v: i for i, v in enumerate(following)}
        seen: list[int] = []  # the sorted places where the segments so far end
        for v in layer:
            ends = [place[w] for w in after[v]]
            total += sum(len(seen) - bisect_right(seen, end) for end in ends)
            for end in ends:
                insort(seen, end)
    return total


def _start(
    graph: LayeredGraph, before: Sequence[Sequence[int]], after: Sequence[Sequence[int]], downwards: bool
) -> list[list[int]]:
    order: list[list[int]] = [[] for _ in graph.order]
    seen = [False] * len(graph.layer)
    first, second = (after, before) if downwards else (before, after)
    roots = [v for layer in (graph.order if downwards else reversed(graph.order)) for v in layer]
    for root in roots:
        if seen[root]:
            continue
        stack = [root]
        while stack:
            v = stack.pop()
            if seen[v]:
                continue
            seen[v] = True
            order[graph.layer[v]].append(v)
            stack.extend(reversed(second[v]))
            stack.extend(reversed(first[v]))
    return order


def _dummies_centred(graph: LayeredGraph, vertices: Sequence[int]) -> list[int]:
    """Return `vertices` with the dummies moved to the middle."""
    others = [v for v in vertices if graph.kind[v] != "dummy"]
    half = len(others) // 2
    return [*others[:half], *(v for v in vertices if graph.kind[v] == "dummy"), *others[half:]]


def _sweep(
    order: list[list[int]], before: Sequence[Sequence[int]], after: Sequence[Sequence[int]], sweeps: int
) -> tuple[list[list[int]], int]:
    place = places(order)
    best = [list(layer) for layer in order]
    least = count_crossings(order, after)
    idle = 0
    for sweep in range(sweeps):
        if not least:
            break
        forward = sweep % 2 == 0
        for at in range(1, len(order)) if forward else range(len(order) - 2, -1, -1):
            _by_barycentre(order[at], before if forward else after, place, sweep % 4 >= 2)
        _transpose(order, before, after, place)
        crossed = count_crossings(order, after)
        if crossed < least:
            best, least, idle = [list(layer) for layer in order], crossed, 0
        else:
            idle += 1
            if idle == _PATIENCE:
                break
    return best, least


def _by_barycentre(layer: list[int], neighbours: Sequence[Sequence[int]], place: list[int], flip: bool) -> None:
    """Sort the vertices that have neighbours by the mean place of their neighbours; the other vertices stay.

    With `flip`, vertices with equal means get the reverse order.
    """
    moving = [(sum(place[w] for w in neighbours[v]) / len(neighbours[v]), v) for v in layer if neighbours[v]]
    if flip:
        moving.reverse()
    moving.sort(key=lambda pair: pair[0])
    rest = iter(moving)
    layer[:] = [next(rest)[1] if neighbours[v] else v for v in layer]
    for i, v in enumerate(layer):
        place[v] = i


def _transpose(
    order: list[list[int]], before: Sequence[Sequence[int]], after: Sequence[Sequence[int]], place: list[int]
) -> None:
    """Swap adjacent vertices in `order` while a swap saves crossings."""
    for _ in range(4):
        saved = False
        for layer in order:
            left = {v: sorted(place[w] for w in before[v]) for v in layer}
            right = {v: sorted(place[w] for w in after[v]) for v in layer}
            improving = True
            while improving:
                improving = False
                for i in range(len(layer) - 1):
                    u, v = layer[i], layer[i + 1]
                    gain = _gain(left[u], left[v]) + _gain(right[u], right[v])
                    if gain > 0:
                        layer[i], layer[i + 1] = v, u
                        place[u], place[v] = i + 1, i
                        improving = saved = True
        if not saved:
            return


def _gain(upper: Sequence[int], lower: Sequence[int]) -> int:
    """Return how many crossings a swap of two vertices saves, given the sorted places of their neighbours."""
    # Now, the line to `end` crosses the lines to places in `lower` before `end`. After the swap, it would cross the
    # lines to places after `end`.
    return sum(bisect_left(lower, end) - len(lower) + bisect_right(lower, end) for end in upper)
