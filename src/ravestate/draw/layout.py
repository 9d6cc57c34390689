"""Layered layout after Sugiyama, Tagawa and Toda (1981), from left to right.

1. Cycle removal reverses some edges (`acyclic`): preferably detached edges and reads.
2. Layer assignment keeps edges short (`simplex`). Layers get a maximum size if the picture would be too tall (`bounded`).
3. Dummy vertices split long edges into short segments (`layered`). Crossing minimisation orders the layers (`crossings`).
4. Coordinate assignment places ports (`layered`) and vertices (`coordinates`).
5. Edge routing sets the distances between the layers and the turns of the lines (`tracks`, `routing`).

Connected components are laid out one by one and packed in rows. The result depends only on the diagram and the order of
its nodes and edges.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

from ravestate.draw.acyclic import STRONG, feedback_arcs
from ravestate.draw.bounded import fit_to_screen
from ravestate.draw.coordinates import assign_coordinates
from ravestate.draw.crossings import minimise_crossings
from ravestate.draw.graph import JUNCTIONS, Diagram, Edge, EdgeKind, NodeKind
from ravestate.draw.layered import LayeredGraph, Link, place_ports, proper_layering
from ravestate.draw.routing import Point, route
from ravestate.draw.simplex import network_simplex
from ravestate.policy.components import components

Size = tuple[float, float]
"""Width and height in pixels."""

_GAP = 32.0  # pixels between two layers if all lines between them are straight
_TURN = 2.0  # average pixels that each port adds to a gap, for the turns of its lines
_BETWEEN = 36.0  # pixels between components
_ASPECT = 1.6  # desired width : height of packed components
_STRENGTH: dict[EdgeKind, int] = {  # kind → the cost of reversing an edge of this kind
    "writes": 3 * STRONG,
    "emits": 4 * STRONG,
    "condition": 4 * STRONG,
    "emits_detached": 1,
    "condition_detached": 2,
    "reads": 2,
}


@dataclass(frozen=True, slots=True)
class Box:
    """A rectangle: its left and upper border, its width and height, in pixels."""

    x: float
    y: float
    width: float
    height: float

    def moved(self, x: float, y: float) -> Box:
        """Return the box, moved right by `x` and down by `y`."""
        return Box(round(self.x + x, 2), round(self.y + y, 2), self.width, self.height)


@dataclass(frozen=True, slots=True)
class Layout:
    """Places of nodes, lines and labels, in pixels from the upper left corner.

    Attributes:
        boxes: Node's id → the node's box.
        lines: For each edge, in the order of the diagram, the points of its line from source to target.
        labels: For each edge, the box of its label; None if the edge has no label.
        width: The width of the picture.
        height: The height of the picture.
    """

    boxes: Mapping[str, Box]
    lines: tuple[tuple[Point, ...], ...]
    labels: tuple[Box | None, ...]
    width: float
    height: float


def lay_out(diagram: Diagram, nodes: Mapping[str, Size], labels: Sequence[Size | None]) -> Layout:
    """Return the layout of a diagram. `nodes` has each node's size by its id; `labels` has the size of each edge's label."""
    boxes: dict[str, Box] = {}
    lines: list[tuple[Point, ...]] = [()] * len(diagram.edges)
    places: list[Box | None] = [None] * len(diagram.edges)
    parts = [_lay_out_component(diagram, ids, edges, nodes, labels) for ids, edges in _components(diagram)]
    width = height = 0.0
    for part, (x, y) in zip(parts, _pack([(part.width, part.height) for part in parts]), strict=True):
        boxes.update({name: box.moved(x, y) for name, box in part.boxes.items()})
        for number, line, label in zip(part.edges, part.lines, part.labels, strict=True):
            lines[number] = tuple((round(px + x, 2), round(py + y, 2)) for px, py in line)
            places[number] = label.moved(x, y) if label is not None else None
        width, height = max(width, x + part.width), max(height, y + part.height)
    ordered = {node.id: boxes[node.id] for node in diagram.nodes}
    return Layout(ordered, tuple(lines), tuple(places), round(width, 2), round(height, 2))


@dataclass(frozen=True, slots=True)
class _Component:
    boxes: dict[str, Box]
    edges: Sequence[int]
    lines: list[list[Point]]
    labels: list[Box | None]
    width: float
    height: float


def _components(diagram: Diagram) -> list[tuple[list[str], list[int]]]:
    """Return the nodes and edges of each connected component, in the order of their first nodes."""
    index = {node.id: place for place, node in enumerate(diagram.nodes)}
    ends = [(index[edge.source], index[edge.target]) for edge in diagram.edges]
    near: list[list[int]] = [[] for _ in diagram.nodes]
    for u, v in ends:
        near[u].append(v)
        near[v].append(u)
    part = components(near).of
    found: dict[int, tuple[list[str], list[int]]] = {}
    for node, number in zip(diagram.nodes, part, strict=True):
        found.setdefault(number, ([], []))[0].append(node.id)
    for number, (u, _) in enumerate(ends):
        found[part[u]][1].append(number)
    return list(found.values())


def _lay_out_component(
    diagram: Diagram,
    ids: Sequence[str],
    numbers: Sequence[int],
    nodes: Mapping[str, Size],
    labels: Sequence[Size | None],
) -> _Component:
    index = {name: i for i, name in enumerate(ids)}
    edges = [diagram.edges[number] for number in numbers]
    ends = [(index[edge.source], index[edge.target]) for edge in edges]
    kinds: dict[str, NodeKind] = {node.id: node.kind for node in diagram.nodes}
    reversals = feedback_arcs(len(ids), [(u, v, _STRENGTH[e.kind]) for (u, v), e in zip(ends, edges, strict=True)])
    links = [
        Link(v if back else u, u if back else v, edge.kind, back, labels[number])
        for (u, v), edge, back, number in zip(ends, edges, reversals, numbers, strict=True)
    ]
    arcs = [
        (link.low, link.high, _tightness(edge, kinds), 1 if link.label is None else 2)
        for link, edge in zip(links, edges, strict=True)
    ]
    sizes = [nodes[name] for name in ids]
    shortest = network_simplex(len(ids), arcs)
    ranks = fit_to_screen(shortest, arcs, lambda ranks: _extent(proper_layering(ranks, sizes, links)))
    graph = proper_layering(ranks, sizes, links)
    is_bounded = ranks != shortest
    minimise_crossings(graph, centred=is_bounded)
    place_ports(graph)
    routed = route(graph, assign_coordinates(graph, _extent(graph)[0] / _ASPECT if is_bounded else None))
    boxes = [
        Box(x - width / 2, y - height / 2, width, height)
        for (x, y), width, height in zip(routed.middles, graph.width, graph.height, strict=True)
    ]
    top = min(box.y for box in boxes)
    boxes = [box.moved(0.0, -top) for box in boxes]
    lines = [[(x, y - top) for x, y in line] for line in routed.lines]
    return _Component(
        {name: boxes[i] for i, name in enumerate(ids)},
        numbers,
        [line[::-1] if link.is_reversed else line for line, link in zip(lines, links, strict=True)],
        [None if vertex is None else boxes[vertex] for vertex in graph.labels],
        max(box.x + box.width for box in boxes),
        max(box.y + box.height for box in boxes),
    )


def _extent(graph: LayeredGraph) -> Size:
    """Return an estimate of a graph's size in pixels, before its coordinates are known."""
    width = sum(max(graph.width[v] for v in layer) + _GAP for layer in graph.order)
    width += _TURN * len({low for low, _ in graph.segments})
    height = max(sum(graph.separation(u, v) for u, v in pairwise(layer)) for layer in graph.order)
    return width, height


def _tightness(edge: Edge, kinds: Mapping[str, NodeKind]) -> int:
    """Return the cost of an edge for each layer that the edge spans.

    High costs keep junctions near rules, and signals near slots.
    """
    if kinds[edge.source] in JUNCTIONS:
        return 8
    if edge.kind == "emits" and kinds[edge.source] == "slot":
        return 4
    return 2 if _STRENGTH[edge.kind] >= STRONG else 1


def _pack(sizes: Sequence[Size]) -> list[Point]:
    """Return the upper left corners of rectangles, packed into rows, the tallest rectangle first."""
    order = sorted(range(len(sizes)), key=lambda i: (-sizes[i][1], i))
    area = sum((width + _BETWEEN) * (height + _BETWEEN) for width, height in sizes)
    wide = max([(area * _ASPECT) ** 0.5, *(width for width, _ in sizes)], default=0.0)
    found: list[Point] = [(0.0, 0.0)] * len(sizes)
    x = y = row = 0.0
    for i in order:
        width, height = sizes[i]
        if x > 0 and x + width > wide:
            x, y, row = 0.0, y + row + _BETWEEN, 0.0
        found[i] = (x, y)
        x += width + _BETWEEN
        row = max(row, height)
    return found
