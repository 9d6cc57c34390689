"""Layers that hold no more than fits: what is too tall for a screen is folded into more layers.

The layers with the shortest edges may be few and crowded: whatever hangs on one hub stands in one layer.
Where that gives a tall and narrow picture, layers get a bound, and vertices above it wait for a later one, as in
the scheduling of Coffman and Graham (1972). Whoever has waited least comes first, so that chains which
have begun run on straight before others begin.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from ravestate.draw.simplex import Arc

__all__ = ["Extent", "bounded", "shaped"]

Extent = tuple[float, float]
"""Width and height in pixels."""

_SCREEN = 720.0  # pixels: what is no higher is seen whole, however narrow it is
_TALLEST = 1.2  # least width : height
_ASPECT = 1.6  # wished width : height
_FOLDS = 16


def shaped(ranks: Sequence[int], arcs: Sequence[Arc], extent: Callable[[Sequence[int]], Extent]) -> list[int]:
    """Layers for a landscape screen: those given, or if their picture were too tall, folded ones.

    Args:
        ranks: The layer of each vertex, from 0.
        arcs: What the layers keep to: every arc spans at least its length.
        extent: How large the picture of some layers will be.
    """
    best, (width, height) = list(ranks), extent(ranks)
    if height <= _SCREEN or width >= _TALLEST * height:
        return best
    nearest = _misfit(width, height)
    crowd = _crowd(ranks)
    for folds in range(2, _FOLDS + 1):
        found = bounded(ranks, arcs, -(-crowd // folds))
        width, height = extent(found)
        misfit = _misfit(width, height)
        if misfit < nearest:
            best, nearest = found, misfit
        if width >= _ASPECT * height:
            break
    return best


def bounded(ranks: Sequence[int], arcs: Sequence[Arc], most: int) -> list[int]:
    """Layers of at most so many vertices each, none before the layer that it has in `ranks`.

    Example:
        >>> bounded([0, 1, 1, 1, 2], [(0, 1, 1, 1), (0, 2, 1, 1), (0, 3, 1, 1), (3, 4, 1, 1)], most=2)
        [0, 1, 2, 1, 2]
    """
    count = len(ranks)
    after: list[list[tuple[int, int]]] = [[] for _ in range(count)]
    waiting = [0] * count
    for u, v, _, length in arcs:
        after[u].append((v, length))
        waiting[v] += 1
    tail = [0] * count  # how many layers follow at least
    for u in reversed(_sorted(after, waiting)):
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


def _sorted(after: Sequence[Sequence[tuple[int, int]]], waiting: Sequence[int]) -> list[int]:
    """The vertices, each after all that lead to it."""
    left = list(waiting)
    order = [v for v in range(len(left)) if not left[v]]
    for u in order:
        for v, _ in after[u]:
            left[v] -= 1
            if not left[v]:
                order.append(v)
    return order


def _crowd(ranks: Sequence[int]) -> int:
    sizes: dict[int, int] = {}
    for rank in ranks:
        sizes[rank] = sizes.get(rank, 0) + 1
    return max(sizes.values())


def _misfit(width: float, height: float) -> float:
    aspect = width / height
    return max(aspect / _ASPECT, _ASPECT / aspect)
