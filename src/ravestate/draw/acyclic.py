"""Acyclic graphs: a topological order, and a small set of edges whose reversal makes a graph acyclic.

The heuristic of Eades, Lin and Smyth (1993) runs within each strongly connected component. It fills an order of the
vertices from both ends at the same time. Then it reverses the edges that point backwards in this order. There are two
refinements. The heuristic prefers to reverse weak edges, whose weight is below `STRONG`. At a tie, it takes the vertex
with the lowest index, so that the result depends only on the input.
"""

from __future__ import annotations

import heapq
from collections import Counter
from collections.abc import Sequence

from ravestate.policy.components import components

STRONG = 1 << 20
"""The minimum weight of a strong edge. The layout reverses a strong edge only if weak edges cannot break the cycle."""


def feedback_arcs(count: int, edges: Sequence[tuple[int, int, int]]) -> list[bool]:
    """Return, for each edge (tail, head, weight) of a graph with `count` vertices, whether to reverse the edge."""
    after: list[list[int]] = [[] for _ in range(count)]
    for u, v, _ in edges:
        after[u].append(v)
    component = components(after).of
    inner = [i for i, (u, v, _) in enumerate(edges) if component[u] == component[v]]
    place = _peel(count, [edges[i] for i in inner])
    found = [False] * len(edges)
    for i in inner:
        found[i] = place[edges[i][0]] > place[edges[i][1]]
    return found


def topological(after: Sequence[Sequence[int]]) -> list[int]:
    """Return the vertices in topological order. Leave out each vertex that is on a cycle, or that a cycle leads to.

    `after` has the successors of each vertex.
    """
    waiting = Counter(v for ahead in after for v in ahead)
    order = [v for v in range(len(after)) if not waiting[v]]
    for u in order:
        for v in after[u]:
            waiting[v] -= 1
            if not waiting[v]:
                order.append(v)
    return order


def _peel(count: int, edges: Sequence[tuple[int, int, int]]) -> list[int]:
    """Return each vertex's position in an order in which few edges point backwards. Most of these edges are weak."""
    after: list[list[tuple[int, int]]] = [[] for _ in range(count)]
    before: list[list[tuple[int, int]]] = [[] for _ in range(count)]
    out = [0] * count
    into = [0] * count
    for u, v, weight in edges:
        after[u].append((v, weight))
        before[v].append((u, weight))
        out[u] += weight
        into[v] += weight
    place = [-1] * count
    first, last = 0, count - 1
    heap = [(*_urgency(out[v], into[v]), v) for v in range(count)]
    heapq.heapify(heap)
    while heap:
        rank, gain, v = heapq.heappop(heap)
        if place[v] >= 0 or (rank, gain) != _urgency(out[v], into[v]):
            continue  # outdated: the heap has a newer entry for this vertex
        if rank in _LAST:
            place[v], last = last, last - 1
        else:
            place[v], first = first, first + 1
        for neighbours, sums in ((after[v], into), (before[v], out)):
            for other, weight in neighbours:
                if place[other] < 0:
                    sums[other] -= weight
                    heapq.heappush(heap, (*_urgency(out[other], into[other]), other))
    return place


_LAST = (0, 2)  # vertices of these ranks (see `_urgency`) get the last free position, other vertices the first one


def _urgency(out: int, into: int) -> tuple[int, int]:
    """Return a vertex's sort key (rank, gain).

    The ranks are: 0 for a sink (no outgoing edges); 1 for a source (no incoming edges); 2 for a sink if
    weak edges are ignored; 3 for a source if weak edges are ignored; 4 for any other vertex. Within a rank, the gain
    compares the vertices by the weights of their edges. The vertex with the least key gets its position next.
    """
    if out == 0:
        return (0, 0)
    if into == 0:
        return (1, 0)
    if into < STRONG:
        return (3, into - out)
    if out < STRONG:
        return (2, out - into)
    return (4, into - out)
