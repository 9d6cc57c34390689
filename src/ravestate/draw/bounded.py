"""Layers of bounded size, for pictures that would be too tall for a screen.

If edges are as short as possible, layers may be few and crowded, e.g. if all the neighbours of a vertex share one layer.
If the picture is then tall and narrow, the number of vertices in a layer gets a bound. Further vertices move to a later
layer, as in the scheduling of Coffman and Graham (1972). A vertex is ready when all its predecessors have a layer. Among
the ready vertices, those that had the latest layer before come first, so that chains continue.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence

from ravestate.draw.acyclic import topological
from ravestate.draw.simplex import Arc

Extent = tuple[float, float]
"""Width and height in pixels."""

SCREEN = 720.0  # pixels: a picture of at most this height fits a screen, even if the picture is narrow
_TALLEST = 1.2  # a picture is too tall if its width : height is less than this
_ASPECT = 1.6  # the best width : height
_SPLITS = 16  # the maximum number of parts into which the largest layer is split


def fit_to_screen(ranks: Sequence[int], arcs: Sequence[Arc], extent: Callable[[Sequence[int]], Extent]) -> list[int]:
    """Return layers that suit a landscape screen: `ranks`, or bounded layers if the picture would be too tall.

    `ranks` has the layer of each vertex. The function `extent` estimates the size of the picture for given layers.
    """
    best, (width, height) = list(ranks), extent(ranks)
    if height <= SCREEN or width >= _TALLEST * height:
        return best
    nearest = _misfit(width, height)
    largest = max(Counter(ranks).values())
    for splits in range(2, _SPLITS + 1):
        found = bounded_layers(ranks, arcs, -(-largest // splits))
        width, height = extent(found)
        misfit = _misfit(width, height)
        if misfit < nearest:
            best, nearest = found, misfit
        if width >= _ASPECT * height:
            break
    return best


def bounded_layers(ranks: Sequence[int], arcs: Sequence[Arc], most: int) -> list[int]:
    """Return layers of at most `most` vertices; no vertex moves to an earlier layer than in `ranks`."""
    count = len(ranks)
    after: list[list[tuple[int, int]]] = [[] for _ in range(count)]
    waiting = [0] * count
    for u, v, _, length in arcs:
        after[u].append((v, length))
        waiting[v] += 1
    tail = [0] * count  # vertex → the length of the longest path from it, in layers
    for u in reversed(topological([[v for v, _ in ahead] for ahead in after])):
        tail[u] = max((tail[v] + length for v, length in after[u]), default=0)
    found = list(ranks)
    layer = 0
    ready = {v for v in range(count) if not waiting[v]}
    while ready:
        here = [v for v in ready if found[v] <= layer]
        here.sort(key=lambda v: (-ranks[v], -tail[v], v))
        for u in here[:most]:
            ready.discard(u)
            found[u] = layer
            for v, length in after[u]:
                found[v] = max(found[v], layer + length)
                waiting[v] -= 1
                if not waiting[v]:
                    ready.add(v)
        layer += 1
    first = min(found, default=0)
    return [layer - first for layer in found]


def _misfit(width: float, height: float) -> float:
    aspect = width / height
    return max(aspect / _ASPECT, _ASPECT / aspect)
