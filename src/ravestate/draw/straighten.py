"""Remove small steps from lines that are almost straight.

Vertices that a straight line joins move together, and only into free space. They move if this straightens a line and
makes no other line much longer.
"""

from __future__ import annotations

from itertools import pairwise

from ravestate.draw.layered import LayeredGraph

_BEND = 60.0  # the cost of a step in a line, in pixels of length
_ROUNDS = 4  # the maximum number of passes over all segments
_LEVEL = 0.01  # pixels: a line with a smaller step counts as straight


class Straightener:
    """Moves the vertices of a graph so that lines become straight.

    It changes `middle`, the y coordinate of each vertex's middle (pixels).
    """

    def __init__(self, graph: LayeredGraph, middle: list[float]) -> None:
        self.graph = graph
        self.middle = middle
        self.above = [-1] * len(middle)
        self.below = [-1] * len(middle)
        for layer in graph.order:
            for u, v in pairwise(layer):
                self.above[v], self.below[u] = u, v
        self.lines: list[list[tuple[int, float]]] = [[] for _ in middle]  # vertex → (neighbour, offset between ports)
        for low, high in graph.segments:
            p, q = graph.ports[low], graph.ports[high]
            self.lines[p.vertex].append((q.vertex, q.offset - p.offset))
            self.lines[q.vertex].append((p.vertex, p.offset - q.offset))
        self.block = [[v] for v in range(len(middle))]  # vertex → the vertices that move together with it

    def run(self) -> None:
        """Straighten as many lines as possible."""
        graph = self.graph
        for _ in range(_ROUNDS):
            for segment in range(len(graph.segments)):
                if abs(self.step(segment)) < _LEVEL:
                    self.join(*graph.ends(segment))
            uneven = [s for s in range(len(graph.segments)) if abs(self.step(s)) >= _LEVEL]
            uneven.sort(key=lambda s: (abs(self.step(s)), s))
            moved = False
            for segment in uneven:
                step = self.step(segment)
                if abs(step) < _LEVEL:
                    continue
                u, v = graph.ends(segment)
                choices = [
                    (gain, block, by) for block, by in ((u, step), (v, -step)) if (gain := self.gain(block, by)) > 0
                ]
                if choices:
                    _, vertex, by = max(choices, key=lambda choice: choice[0])
                    for member in self.block[vertex]:
                        self.middle[member] += by
                    self.join(u, v)
                    moved = True
            if not moved:
                return

    def step(self, segment: int) -> float:
        """Return how many pixels the right end of a segment is below its left end."""
        low, high = self.graph.segments[segment]
        p, q = self.graph.ports[low], self.graph.ports[high]
        return self.middle[q.vertex] + q.offset - self.middle[p.vertex] - p.offset

    def gain(self, vertex: int, by: float) -> float:
        """Return the cost saved by moving a vertex's block down by `by` pixels; negative if there is no room."""
        block = self.block[vertex]
        saved = 0.0
        for v in block:
            other = self.below[v] if by > 0 else self.above[v]
            if other >= 0 and self.block[other] is not block:
                upper, lower = (v, other) if by > 0 else (other, v)
                room = abs(self.middle[other] - self.middle[v]) - self.graph.separation(upper, lower)
                if room < abs(by) - 1e-6:
                    return -1.0
            for w, offset in self.lines[v]:
                if self.block[w] is not block:
                    step = self.middle[w] + offset - self.middle[v]
                    saved += _cost(step) - _cost(step - by)
        return saved

    def join(self, u: int, v: int) -> None:
        """Let the blocks of two vertices move together from now on."""
        a, b = self.block[u], self.block[v]
        if a is not b:
            a += b
            for member in b:
                self.block[member] = a


def _cost(step: float) -> float:
    return abs(step) + _BEND if abs(step) >= _LEVEL else 0.0
