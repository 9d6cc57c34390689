"""In a layout, nothing overlaps, and each line joins its nodes."""

from itertools import combinations, pairwise

import pytest
from hypothesis import given

from draw.examples import diagrams, games, many_rules, prompting, question_answering
from ravestate.declare.module import Module
from ravestate.draw.build import build
from ravestate.draw.graph import Diagram
from ravestate.draw.layout import Box, Layout, lay_out
from ravestate.draw.routing import Point
from ravestate.draw.text import label_size, node_size

NEAR = 0.05


def laid_out(diagram: Diagram) -> Layout:
    sizes = {node.id: node_size(node) for node in diagram.nodes}
    return lay_out(diagram, sizes, [label_size(edge.label) for edge in diagram.edges])


def overlap(a: Box, b: Box) -> bool:
    across = min(a.x + a.width, b.x + b.width) - max(a.x, b.x)
    down = min(a.y + a.height, b.y + b.height) - max(a.y, b.y)
    return across > NEAR and down > NEAR


def at_side(point: Point, box: Box) -> bool:
    x, y = point
    return min(abs(x - box.x), abs(x - box.x - box.width)) < NEAR and box.y < y < box.y + box.height


def enters(line: tuple[Point, ...], box: Box) -> bool:
    """Return whether a line runs through the inside of a box. Clip each segment at the four borders."""
    low = (box.x + NEAR, box.y + NEAR)
    high = (box.x + box.width - NEAR, box.y + box.height - NEAR)
    for a, b in pairwise(line):
        first, last = 0.0, 1.0
        for axis in (0, 1):
            step = b[axis] - a[axis]
            if abs(step) < NEAR:
                first, last = (first, last) if low[axis] < a[axis] < high[axis] else (1.0, 0.0)
            else:
                one, two = sorted(((low[axis] - a[axis]) / step, (high[axis] - a[axis]) / step))
                first, last = max(first, one), min(last, two)
        if first < last:
            return True
    return False


def check(diagram: Diagram) -> None:
    layout = laid_out(diagram)
    assert list(layout.boxes) == [node.id for node in diagram.nodes]
    placed = [*layout.boxes.values(), *(label for label in layout.labels if label is not None)]
    for a, b in combinations(placed, 2):
        assert not overlap(a, b)
    for box in placed:
        assert box.x >= -NEAR and box.x + box.width <= layout.width + NEAR
        assert box.y >= -NEAR and box.y + box.height <= layout.height + NEAR
    for edge, line, label in zip(diagram.edges, layout.lines, layout.labels, strict=True):
        assert len(line) >= 2
        assert at_side(line[0], layout.boxes[edge.source])
        assert at_side(line[-1], layout.boxes[edge.target])
        assert (label is not None) == bool(edge.label)
        if label is not None:
            assert enters(line, label)
        for name, box in layout.boxes.items():
            assert not enters(line, box), f"{edge} runs through {name}"


@given(diagrams())
def test_nothing_overlaps_and_each_line_joins_its_nodes(diagram: Diagram) -> None:
    check(diagram)


@pytest.mark.parametrize("module", [question_answering(), games(), prompting(), many_rules(120)], ids=repr)
def test_in_the_examples_nothing_overlaps_and_no_line_crosses_a_node(module: Module) -> None:
    check(build(module.rules))


@given(diagrams())
def test_lines_without_a_common_node_never_overlap(diagram: Diagram) -> None:
    layout = laid_out(diagram)
    for (e, line), (f, other) in combinations(zip(diagram.edges, layout.lines, strict=True), 2):
        if {e.source, e.target} & {f.source, f.target}:
            continue
        for (a, b), (c, d) in ((s, t) for s in pairwise(line) for t in pairwise(other)):
            for this, that in ((0, 1), (1, 0)):
                if abs(a[this] - b[this]) < NEAR and abs(c[this] - d[this]) < NEAR and abs(a[this] - c[this]) < 1.0:
                    shared = min(max(a[that], b[that]), max(c[that], d[that])) - max(
                        min(a[that], b[that]), min(c[that], d[that])
                    )
                    assert shared < NEAR, f"{e} and {f}"


def test_an_empty_diagram_has_no_size() -> None:
    layout = laid_out(Diagram((), ()))
    assert (layout.width, layout.height) == (0.0, 0.0)


def test_causes_are_left_of_their_effects() -> None:
    layout = laid_out(build(games().rules))
    x = {name: box.x for name, box in layout.boxes.items()}
    assert (
        x["slot demo:input"]
        < x["signal demo:input:changed"]
        < x["rule demo:Question"]
        < x["signal demo:question"]
        < x["and demo:OfferGames 0"]
        < x["rule demo:OfferGames"]
        < x["slot demo:output"]
    )


def test_only_the_detached_edge_of_a_loop_runs_backwards() -> None:
    diagram = build(prompting().rules)
    layout = laid_out(diagram)
    back = [e for e, line in zip(diagram.edges, layout.lines, strict=True) if line[-1][0] < line[0][0]]
    assert [(e.source, e.target, e.kind) for e in back] == [
        ("rule prompt:PromptAgain", "signal prompt:prompted", "emits_detached")
    ]
