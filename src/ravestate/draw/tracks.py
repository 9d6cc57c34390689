"""Orthogonal routing between two layers: the track on which each line turns.

Segments that leave or enter one port (a point on the side of a vertex) form a net: one vertical line with horizontal
stubs to both sides. Nets get tracks from left to right. Two constraints order the nets: stubs of different nets must not
overlap (strong), and few stubs should cross the vertical lines of other nets (weak).
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field

from ravestate.draw.acyclic import STRONG, feedback_arcs, topological

Segment = tuple[int, int, float, float]
"""The port at the left end, the port at the right end, and the y coordinates of both (pixels)."""

_NEAR = 5.0  # pixels: closer stubs look like one line
_APART = 7.0  # pixels: minimum distance between two vertical lines on one track
_LEVEL = 0.01  # pixels: a net needs no track if the y coordinates of its ends differ by less
_TOUCHING = 4 * STRONG  # the cost of overlapping stubs, far above the cost of all crossings together


@dataclass(slots=True)
class Tracks:
    """The number of tracks, and the index of each segment's track; None for a segment without a turn.

    Such a segment is horizontal. Rarely, it is slanted instead, because no order of the nets keeps their stubs apart.
    """

    count: int
    of: list[int | None]


@dataclass(slots=True)
class _Net:
    """A net: its segments, the y coordinate of each left and each right port, and its least and greatest y (pixels)."""

    segments: list[int] = field(default_factory=list[int])
    left: dict[int, float] = field(default_factory=dict[int, float])
    right: dict[int, float] = field(default_factory=dict[int, float])
    top: float = 0.0
    bottom: float = 0.0


def tracks(segments: Sequence[Segment]) -> Tracks:
    """Return the tracks of the segments between two layers."""
    nets = _nets(segments)
    found = Tracks(0, [None] * len(segments))
    if not nets:
        return found
    joined = {(p, q) for p, q, _, _ in segments}
    wishes: list[tuple[int, int, int]] = []  # (a net, a net that should be to its right, the weight of this wish)
    by_top = sorted(range(len(nets)), key=lambda i: (nets[i].top, i))
    overlaps: list[list[int]] = [[] for _ in nets]  # net → the nets that cannot be on the same track
    for at, i in enumerate(by_top):
        for j in by_top[at + 1 :]:
            if nets[j].top > nets[i].bottom + _APART:
                break
            a, b = min(i, j), max(i, j)
            overlaps[a].append(b)
            overlaps[b].append(a)
            first, second = _cost(nets[a], nets[b], joined), _cost(nets[b], nets[a], joined)
            if first >= STRONG and second >= STRONG:
                wishes += [(a, b, _TOUCHING), (b, a, _TOUCHING)]
            elif first < second:
                wishes.append((a, b, second - first))
            elif second < first:
                wishes.append((b, a, first - second))
    slanted: set[int] = set()
    after: list[list[int]] = [[] for _ in nets]
    for (a, b, weight), is_reversed in zip(wishes, feedback_arcs(len(nets), wishes), strict=True):
        if is_reversed and weight >= STRONG:
            slanted |= _offending(nets[a], nets[b], segments, joined)
        u, v = (b, a) if is_reversed else (a, b)
        after[u].append(v)
    place = [-1] * len(nets)
    least = [0] * len(nets)
    for i in topological(after):
        turning = [segment for segment in nets[i].segments if segment not in slanted]
        if turning:
            used = {place[j] for j in overlaps[i]}
            track = least[i]
            while track in used:
                track += 1
            place[i] = track
            found.count = max(found.count, track + 1)
            for segment in turning:
                found.of[segment] = track
        for j in after[i]:
            least[j] = max(least[j], place[i] + 1)
    return found


def _nets(segments: Sequence[Segment]) -> list[_Net]:
    leaving = Counter(p for p, _, _, _ in segments)
    entering = Counter(q for _, q, _, _ in segments)
    nets: dict[tuple[bool, int], _Net] = {}
    for number, (p, q, y, z) in enumerate(segments):
        key = (False, p) if leaving[p] >= entering[q] else (True, q)
        net = nets.setdefault(key, _Net())
        net.segments.append(number)
        net.left[p] = y
        net.right[q] = z
    found: list[_Net] = []
    for net in nets.values():
        heights = [*net.left.values(), *net.right.values()]
        net.top, net.bottom = min(heights), max(heights)
        if net.bottom - net.top > _LEVEL:
            found.append(net)
    return found


def _offending(a: _Net, b: _Net, segments: Sequence[Segment], joined: set[tuple[int, int]]) -> set[int]:
    """Return the segments to slant if net `a` cannot be to the left of net `b`.

    If two stubs overlap, slant the segments of the stub that has fewer segments.
    """
    found: set[int] = set()
    for p, y in a.left.items():
        for q, z in b.right.items():
            if abs(y - z) < _NEAR and (p, q) not in joined:
                leaving = [segment for segment in a.segments if segments[segment][0] == p]
                entering = [segment for segment in b.segments if segments[segment][1] == q]
                found.update(leaving if len(leaving) < len(entering) else entering)
    return found


def _cost(a: _Net, b: _Net, joined: set[tuple[int, int]]) -> int:
    """Return the cost of putting net `a` to the left of net `b`: crossings, and overlapping stubs."""
    cost = 0
    for p, y in b.left.items():
        if a.top < y < a.bottom and p not in a.left:
            cost += 1
        for q, z in a.right.items():
            if abs(y - z) < _NEAR and (p, q) not in joined:
                cost += _TOUCHING
    for q, z in a.right.items():
        if b.top < z < b.bottom and q not in b.right:
            cost += 1
    return cost
