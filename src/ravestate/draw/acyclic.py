"""Which edges to turn round so that no cycle is left.

The heuristic of Eades, Lin and Smyth (1993) within each strongly connected component: vertices are
peeled off from both ends of an order, and the edges that point backwards in it are the answer. Two
refinements: weak edges are turned before strong ones, and ties go by number, so that the answer
depends on nothing but its input.
"""

from __future__ import annotations

import heapq
from collections.abc import Sequence

__all__ = ["STRONG", "backward"]

STRONG = 1 << 20
"""A weight from which an edge is strong: turned only where weak edges alone do not break the cycle."""


def backward(count: int, edges: Sequence[tuple[int, int, int]]) -> list[bool]:
    """For each edge (tail, head, weight) of a graph with `count` vertices: whether to turn it round."""
    component = _components(count, edges)
    inner = [i for i, (u, v, _) in enumerate(edges) if component[u] == component[v]]
    place = _peel(count, [edges[i] for i in inner])
    turned = [False] * len(edges)
    for i in inner:
        turned[i] = place[edges[i][0]] > place[edges[i][1]]
    return turned


def _peel(count: int, edges: Sequence[tuple[int, int, int]]) -> list[int]:
    """Number the vertices so that few and weak edges point backwards."""
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
            continue  # outdated: a fresher entry is in the heap
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


_LAST = (0, 2)


def _urgency(out: int, into: int) -> tuple[int, int]:
    """Sinks go last; then sources first; then sinks and sources of the strong edges; then the best bargain."""
    if out == 0:
        return (0, 0)
    if into == 0:
        return (1, 0)
    if into < STRONG:
        return (3, into - out)
    if out < STRONG:
        return (2, out - into)
    return (4, into - out)


def _components(count: int, edges: Sequence[tuple[int, int, int]]) -> list[int]:
    """The strongly connected component of each vertex (Tarjan, without recursion)."""
    after: list[list[int]] = [[] for _ in range(count)]
    for u, v, _ in edges:
        after[u].append(v)
    number = [-1] * count
    low = [0] * count
    component = [-1] * count
    open_: list[int] = []
    counter = 0
    for root in range(count):
        if number[root] >= 0:
            continue
        number[root] = low[root] = counter
        counter += 1
        open_.append(root)
        path = [(root, iter(after[root]))]
        while path:
            v, rest = path[-1]
            for w in rest:
                if number[w] < 0:
                    number[w] = low[w] = counter
                    counter += 1
                    open_.append(w)
                    path.append((w, iter(after[w])))
                    break
                if component[w] < 0:
                    low[v] = min(low[v], number[w])
            else:
                path.pop()
                if path:
                    low[path[-1][0]] = min(low[path[-1][0]], low[v])
                if low[v] == number[v]:
                    while True:
                        w = open_.pop()
                        component[w] = v
                        if w == v:
                            break
    return component
