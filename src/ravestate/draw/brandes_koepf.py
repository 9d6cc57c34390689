"""Vertical coordinates by Brandes and Köpf (2002): no overlaps, and straight long edges.

Each vertex is aligned with its median neighbours in four ways: from the left or the right, upwards or downwards. Each
alignment is packed tightly. Each vertex gets the average of the two middle values of its four places. The alignment is
between ports rather than middles, so that a line between two ports is straight.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

from ravestate.draw.acyclic import topological
from ravestate.draw.layered import LayeredGraph, places

_GAPS = {(True, True): 16.0, (True, False): 12.0, (False, True): 12.0, (False, False): 9.0}
"""(upper, lower neighbour in a layer) → the minimum pixels between them; `False` stands for a dummy vertex."""


def separation(graph: LayeredGraph, upper: int, lower: int) -> float:
    """Return the minimum distance in pixels between the middles of two adjacent vertices of a layer."""
    solid = (graph.kind[upper] != "dummy", graph.kind[lower] != "dummy")
    return (graph.height[upper] + graph.height[lower]) / 2 + _GAPS[solid]


def brandes_koepf(graph: LayeredGraph) -> list[float]:
    """Return the vertical middle of each vertex in pixels; the upper border of the topmost vertex is at 0."""
    crossed = _forbidden(graph)
    ways = ((True, True), (True, False), (False, True), (False, False))
    found = [_aligned(graph, crossed, from_left, downwards) for from_left, downwards in ways]
    spans = [max(ys) - min(ys) for ys in found]
    narrow = found[spans.index(min(spans))]
    for i, ys in enumerate(found):
        shift = max(narrow) - max(ys) if i % 2 else min(narrow) - min(ys)
        found[i] = [y + shift for y in ys]
    result = [sum(sorted(ys[v] for ys in found)[1:3]) / 2 for v in range(len(graph.layer))]
    top = min((y - graph.height[v] / 2 for v, y in enumerate(result)), default=0.0)
    return [y - top for y in result]


def _forbidden(graph: LayeredGraph) -> set[int]:
    """Return the segments that cross a segment between two dummies (type 1 conflicts); they are never aligned."""
    place = places(graph.order)
    by_layer: list[list[tuple[int, int, int, bool]]] = [[] for _ in graph.order]
    for segment in range(len(graph.segments)):
        u, v = graph.ends(segment)
        inner = graph.kind[u] == "dummy" and graph.kind[v] == "dummy"
        by_layer[graph.layer[u]].append((place[u], place[v], segment, inner))
    crossed: set[int] = set()
    for found in by_layer:
        inner = sorted((a, b) for a, b, _, is_inner in found if is_inner)
        if not inner:
            continue
        for a, b, segment, is_inner in found:
            if not is_inner and any((a < c and b > d) or (a > c and b < d) for c, d in inner):
                crossed.add(segment)
    return crossed


def _aligned(graph: LayeredGraph, crossed: set[int], from_left: bool, downwards: bool) -> list[float]:
    """Return the vertical middle of each vertex in one of the four alignments."""
    count = len(graph.layer)
    sign = 1.0 if downwards else -1.0
    order = graph.order if from_left else graph.order[::-1]
    if not downwards:
        order = [layer[::-1] for layer in order]
    place = places(order)
    # Vertex → (place of a neighbour, the neighbour, how far below the neighbour the vertex goes if
    # the two are aligned, the segment between the two).
    towards: list[list[tuple[int, int, float, int]]] = [[] for _ in range(count)]
    for segment, (low, high) in enumerate(graph.segments):
        p, q = graph.ports[low], graph.ports[high]
        if not from_left:
            p, q = q, p
        towards[q.vertex].append((place[p.vertex], p.vertex, sign * (p.offset - q.offset), segment))
    root = list(range(count))
    shift = [0.0] * count  # vertex → its offset from the root of its block
    taken = [False] * count
    for layer in order:
        limit = -1
        for v in layer:
            near = sorted(towards[v])
            if not near:
                continue
            half = (len(near) - 1) // 2
            for at, u, offset, segment in near[half : len(near) - half]:
                if root[v] == v and not taken[u] and limit < at and segment not in crossed:
                    taken[u] = True
                    root[v] = root[u]
                    shift[v] = shift[u] + offset
                    limit = at
                    break
    return [sign * y for y in _packed(graph, order, root, shift)]


def _packed(
    graph: LayeredGraph, order: Sequence[Sequence[int]], root: Sequence[int], shift: Sequence[float]
) -> list[float]:
    """Return each vertex's middle after each block moved up as far as possible, then down as far as there is room."""
    count = len(root)
    lower: list[list[tuple[int, float]]] = [[] for _ in range(count)]
    upper: list[list[tuple[int, float]]] = [[] for _ in range(count)]
    for layer in order:
        for u, v in pairwise(layer):
            gap = separation(graph, u, v) + shift[u] - shift[v]
            lower[root[u]].append((root[v], gap))
            upper[root[v]].append((root[u], gap))
    sequence = topological([[v for v, _ in pairs] for pairs in lower])
    place = [0.0] * count
    for block in sequence:
        place[block] = max((place[u] + gap for u, gap in upper[block]), default=0.0)
    for block in reversed(sequence):
        if lower[block]:
            place[block] = max(place[block], min(place[v] - gap for v, gap in lower[block]))
    return [place[root[v]] + shift[v] for v in range(count)]
