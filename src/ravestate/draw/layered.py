"""A proper layered graph: each segment joins two neighbouring layers.

Vertices are the nodes of the diagram, the labels of its edges, and dummies (points where a long edge passes a layer). A
line begins and ends at a port (a point on a vertex). Edges of one kind and direction share one port on each side of a
node. Long edges that begin (or end) at one port share their dummies, too. So a node with many edges has one line with
branches (a hyperedge) instead of many parallel lines.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Literal

from ravestate.draw.graph import EdgeKind
from ravestate.draw.style import EDGE_STYLES

VertexKind = Literal["node", "label", "dummy"]

_GAPS = {(True, True): 16.0, (True, False): 12.0, (False, True): 12.0, (False, False): 9.0}
"""The minimum gap between two adjacent vertices (pixels). Key: whether the upper vertex is a node or a label (False for
a dummy), and the same for the lower vertex."""
_SOLID = [kind for kind, style in EDGE_STYLES.items() if not style.dashes]
"""The kinds of edges whose lines may overlap. Dashed lines would blur each other."""
_PITCH = 10.0  # pixels between the ports of one side, if there is room
_MARGIN = 10.0  # pixels from a corner, which may be round, to the first or last port
_LEAST = 3.0  # minimum pixels between ports; with less room, ports coincide, but entering and leaving lines stay apart


@dataclass(frozen=True, slots=True)
class Link:
    """An edge of the acyclic graph, from a lower to a higher layer; `is_reversed` if its arrow points the other way."""

    low: int
    high: int
    kind: EdgeKind
    is_reversed: bool
    label: tuple[float, float] | None
    """The width and height of the edge's label in pixels; None without a label."""


@dataclass(slots=True)
class Port:
    """A point where lines touch a vertex: on its `right` or left side, `offset` pixels below its middle.

    `enters` says whether the arrows of these lines lead into the vertex.
    """

    vertex: int
    right: bool
    enters: bool
    offset: float = 0.0


Chain = list[int]
"""The indices of the segments of a link, from its lower to its higher end."""


@dataclass(slots=True)
class LayeredGraph:
    """The graph: its vertices by index, ports, segments between ports, and the order of each layer."""

    layer: list[int] = field(default_factory=list[int])
    kind: list[VertexKind] = field(default_factory=list[VertexKind])
    width: list[float] = field(default_factory=list[float])
    height: list[float] = field(default_factory=list[float])
    ports: list[Port] = field(default_factory=list[Port])
    segments: list[tuple[int, int]] = field(default_factory=list[tuple[int, int]])
    """Pairs of ports: one on the right side of a vertex, one on the left side of a vertex in the next layer."""
    chains: list[Chain] = field(default_factory=list[Chain])
    labels: list[int | None] = field(default_factory=list[int | None])
    """Link → the vertex of its label; None if the link has no label."""
    order: list[list[int]] = field(default_factory=list[list[int]])
    """Layer → its vertices, from top to bottom."""

    def ends(self, segment: int) -> tuple[int, int]:
        """Return the two vertices that a segment joins."""
        low, high = self.segments[segment]
        return self.ports[low].vertex, self.ports[high].vertex

    def separation(self, upper: int, lower: int) -> float:
        """Return the minimum distance in pixels between the middles of two adjacent vertices of a layer."""
        solid = (self.kind[upper] != "dummy", self.kind[lower] != "dummy")
        return (self.height[upper] + self.height[lower]) / 2 + _GAPS[solid]

    def neighbours(self) -> tuple[list[list[int]], list[list[int]]]:
        """Return two lists: vertex → its neighbours in the layer before, and the same for the layer after.

        A neighbour occurs once for each segment.
        """
        before: list[list[int]] = [[] for _ in self.layer]
        after: list[list[int]] = [[] for _ in self.layer]
        for segment in range(len(self.segments)):
            u, v = self.ends(segment)
            after[u].append(v)
            before[v].append(u)
        return before, after


def proper_layering(ranks: Sequence[int], sizes: Sequence[tuple[float, float]], links: Sequence[Link]) -> LayeredGraph:
    """Return the graph, with a dummy wherever a link passes a layer. A layer's vertices are in order of creation.

    `ranks` has the layer of each node; `sizes` has its width and height (pixels).
    """
    graph = LayeredGraph()
    builder = _Builder(graph)
    for rank, (width, height) in zip(ranks, sizes, strict=True):
        builder.vertex(rank, "node", width, height)
    long = [link for link in links if ranks[link.high] - ranks[link.low] > 1]
    from_low, from_high = Counter(map(_low, long)), Counter(map(_high, long))
    for link in links:
        share_low = from_low[_low(link)] >= from_high[_high(link)]
        if link.label is not None or link.kind not in _SOLID:
            # A label needs a piece of line that belongs only to its edge, near the arrow's head. And dashed lines may
            # overlap only at their start, because the dashes of two lines match only there.
            # So such links share their dummies at the start of the arrow.
            share_low = not link.is_reversed
        builder.link(link, ranks[link.low], ranks[link.high], share_low)
    graph.order = [[] for _ in range(max(graph.layer, default=-1) + 1)]
    for vertex, layer in enumerate(graph.layer):
        graph.order[layer].append(vertex)
    return graph


def places(order: Sequence[Sequence[int]]) -> list[int]:
    """Return each vertex's place within its layer, given the vertices of each layer."""
    found = [0] * sum(map(len, order))
    for layer in order:
        for place, vertex in enumerate(layer):
            found[vertex] = place
    return found


def _low(link: Link) -> tuple[object, ...]:
    return (link.low, link.kind, link.is_reversed)


def _high(link: Link) -> tuple[object, ...]:
    return (link.high, link.kind, link.is_reversed)


class _Builder:
    def __init__(self, graph: LayeredGraph) -> None:
        self.graph = graph
        self.ports: dict[tuple[object, ...], int] = {}
        self.dummies: dict[tuple[object, ...], int] = {}
        self.known: dict[tuple[int, int], int] = {}  # pair of ports → the index of its segment

    def vertex(self, layer: int, kind: VertexKind, width: float, height: float) -> int:
        graph = self.graph
        graph.layer.append(layer)
        graph.kind.append(kind)
        graph.width.append(width)
        graph.height.append(height)
        return len(graph.layer) - 1

    def port(self, vertex: int, right: bool, key: tuple[EdgeKind, bool] | None = None) -> int:
        whole = (vertex, right, key)
        found = self.ports.get(whole)
        if found is None:
            found = self.ports[whole] = len(self.graph.ports)
            self.graph.ports.append(Port(vertex, right, enters=key is not None and key[1] == right))
        return found

    def link(self, link: Link, first: int, last: int, share_low: bool) -> None:
        share = ("low", *_low(link)) if share_low else ("high", *_high(link))
        style = (link.kind, link.is_reversed)
        labelled = None if link.label is None else (first + 1 if link.is_reversed else last - 1)
        label: int | None = None
        chain: Chain = []
        port = self.port(link.low, True, style)
        for layer in range(first + 1, last):
            if layer == labelled and link.label is not None:
                vertex = label = self.vertex(layer, "label", *link.label)
            else:
                key = (*share, layer)
                vertex = self.dummies.get(key, -1)
                if vertex < 0:
                    vertex = self.dummies[key] = self.vertex(layer, "dummy", 0.0, 0.0)
            chain.append(self.segment(port, self.port(vertex, False)))
            port = self.port(vertex, True)
        chain.append(self.segment(port, self.port(link.high, False, style)))
        self.graph.chains.append(chain)
        self.graph.labels.append(label)

    def segment(self, low: int, high: int) -> int:
        key = (low, high)
        found = self.known.get(key)
        if found is None:
            found = self.known[key] = len(self.graph.segments)
            self.graph.segments.append(key)
        return found


def place_ports(graph: LayeredGraph) -> None:
    """Place the ports on each side of a node in the order of the vertices to which they lead. `order` must be final."""
    place = places(graph.order)
    leads: list[list[int]] = [[] for _ in graph.ports]
    for low, high in graph.segments:
        leads[low].append(place[graph.ports[high].vertex])
        leads[high].append(place[graph.ports[low].vertex])
    sides: dict[tuple[int, bool], list[int]] = {}
    for number, port in enumerate(graph.ports):
        sides.setdefault((port.vertex, port.right), []).append(number)
    for (vertex, _), numbers in sides.items():
        if len(numbers) == 1 or graph.kind[vertex] != "node":
            continue
        numbers.sort(key=lambda number: (sum(leads[number]) / len(leads[number]), number))
        pitch = min(_PITCH, (graph.height[vertex] - 2 * _MARGIN) / (len(numbers) - 1))
        if pitch >= _LEAST:
            for i, number in enumerate(numbers):
                graph.ports[number].offset = round(pitch * (i - (len(numbers) - 1) / 2), 2)
        elif len({graph.ports[number].enters for number in numbers}) > 1:
            first = graph.ports[numbers[0]].enters
            for number in numbers:
                graph.ports[number].offset = -_LEAST if graph.ports[number].enters == first else _LEAST
