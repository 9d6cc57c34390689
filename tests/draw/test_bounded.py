"""Layers of bounded size, for pictures that suit a landscape screen."""

import os
import subprocess
import sys
from collections import Counter
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from draw.examples import EDGE_KINDS, games, many_rules, prompting, question_answering, star
from draw.test_layout import check, laid_out
from ravestate.declare.module import Module
from ravestate.draw.bounded import bounded_layers, fit_to_screen
from ravestate.draw.build import build
from ravestate.draw.graph import Diagram, Edge
from ravestate.draw.simplex import Arc, network_simplex


@st.composite
def graphs(draw: st.DrawFn) -> tuple[int, list[Arc]]:
    """A connected graph without cycles: each vertex except the first has a predecessor."""
    count = draw(st.integers(1, 30))
    arcs = [(draw(st.integers(0, v - 1)), v, draw(st.integers(1, 4)), draw(st.integers(1, 2))) for v in range(1, count)]
    if count > 1:
        for u, v in draw(st.lists(st.tuples(st.integers(0, count - 1), st.integers(0, count - 1)), max_size=20)):
            if u < v:
                arcs.append((u, v, 1, 1))
    return count, arcs


@given(graphs(), st.integers(1, 8))
def test_no_layer_exceeds_the_bound_and_each_arc_spans_its_minimum_length(
    graph: tuple[int, list[Arc]], most: int
) -> None:
    count, arcs = graph
    found = bounded_layers(network_simplex(count, arcs), arcs, most)
    assert max(Counter(found).values()) <= most
    assert min(found) == 0
    for u, v, _, length in arcs:
        assert found[v] - found[u] >= length


def test_a_chain_is_completed_before_another_chain_begins() -> None:
    arcs = [(0, head, 1, 1) for head in (1, 3, 5, 7)] + [(head, head + 1, 1, 1) for head in (1, 3, 5, 7)]
    found = bounded_layers(network_simplex(9, arcs), arcs, 2)
    assert [found[head] for head in (1, 3, 5, 7)] == [1, 1, 3, 3]
    assert all(found[head + 1] == found[head] + 1 for head in (1, 3, 5, 7))


def test_a_picture_that_is_wide_enough_keeps_its_layers() -> None:
    arcs = [(0, v, 1, 1) for v in range(1, 40)]
    ranks = network_simplex(40, arcs)
    assert fit_to_screen(ranks, arcs, lambda _: (1000.0, 800.0)) == ranks
    # A narrow picture keeps its layers if it is no higher than a screen, or if bounded layers would not make it lower.
    assert fit_to_screen(ranks, arcs, lambda _: (100.0, 700.0)) == ranks
    assert fit_to_screen(ranks, arcs, lambda _: (100.0, 2000.0)) == ranks


@pytest.mark.parametrize("points", [20, 30, 60, 120])
@pytest.mark.parametrize("pairs", [False, True], ids=["one-slot", "own-signals"])
def test_a_hub_and_its_neighbours_fill_a_landscape_screen(points: int, pairs: bool) -> None:
    diagram = star(points, pairs)
    layout = laid_out(diagram)
    assert 1.0 <= layout.width / layout.height <= 2.0
    check(diagram)


@pytest.mark.parametrize("module", [question_answering(), games(), prompting(), many_rules(120)], ids=repr)
def test_the_examples_are_at_least_as_wide_as_they_are_high(module: Module) -> None:
    layout = laid_out(build(module.rules))
    assert layout.width >= layout.height


@st.composite
def tangled_stars(draw: st.DrawFn) -> Diagram:
    """A hub with neighbours, and a few more edges in any direction, some with a label."""
    diagram = star(draw(st.integers(8, 20)), draw(st.booleans()))
    ids = st.sampled_from([node.id for node in diagram.nodes])
    edges = [
        Edge(source, target, draw(st.sampled_from(EDGE_KINDS)), draw(st.sampled_from(["", "any age"])))
        for source, target in draw(st.lists(st.tuples(ids, ids), max_size=12))
        if source != target
    ]
    return Diagram(diagram.nodes, (*diagram.edges, *edges))


@given(tangled_stars())
def test_with_bounded_layers_nothing_overlaps_and_each_line_joins_its_nodes(diagram: Diagram) -> None:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("ravestate.draw.bounded.SCREEN", 200.0)
        check(diagram)


def test_with_bounded_layers_lines_run_from_left_to_right() -> None:
    diagram = star(60, pairs=True)
    layout = laid_out(diagram)
    for edge in diagram.edges:
        source, target = layout.boxes[edge.source], layout.boxes[edge.target]
        assert source.x + source.width < target.x


def test_the_layout_does_not_depend_on_the_hash_seed() -> None:
    program = (
        "from draw.examples import star\nfrom draw.test_layout import laid_out\nprint(laid_out(star(40, pairs=True)))"
    )
    tests = Path(__file__).parents[1]
    found = {
        subprocess.run(
            [sys.executable, "-c", program],
            env={**os.environ, "PYTHONHASHSEED": seed, "PYTHONPATH": os.pathsep.join([str(tests), *sys.path])},
            capture_output=True, text=True, check=True,
        ).stdout
        for seed in ("0", "1", "2")
    }  # fmt: skip
    assert len(found) == 1
