"""Coordinates keep the vertices of a layer apart, and make long lines straight."""

from itertools import pairwise

from hypothesis import given
from hypothesis import strategies as st

from ravestate.draw.coordinates import assign_coordinates
from ravestate.draw.crossings import minimise_crossings
from ravestate.draw.layered import LayeredGraph, Link, place_ports, proper_layering


@st.composite
def arranged(draw: st.DrawFn) -> LayeredGraph:
    count = draw(st.integers(1, 12))
    ranks = sorted(draw(st.lists(st.integers(0, 4), min_size=count, max_size=count)))
    names = {rank: i for i, rank in enumerate(sorted(set(ranks)))}
    ranks = [names[rank] for rank in ranks]  # number the layers without gaps
    ends = draw(st.lists(st.tuples(st.integers(0, count - 1), st.integers(0, count - 1)), max_size=24))
    kinds = st.sampled_from(("writes", "reads", "condition"))
    links = [Link(u, v, draw(kinds), draw(st.booleans()), None) for u, v in ends if ranks[u] < ranks[v]]
    sizes = [(50.0, draw(st.sampled_from((22.0, 38.0, 50.0)))) for _ in range(count)]
    graph = proper_layering(ranks, sizes, links)
    minimise_crossings(graph)
    place_ports(graph)
    return graph


@given(graph=arranged(), room=st.sampled_from((None, 200.0)))
def test_neighbours_in_a_layer_keep_their_minimum_distance(graph: LayeredGraph, room: float | None) -> None:
    middle = assign_coordinates(graph, room)
    for layer in graph.order:
        for u, v in pairwise(layer):
            assert middle[v] - middle[u] >= graph.separation(u, v) - 1e-6


def test_a_long_line_without_obstacles_is_straight() -> None:
    sizes = [(50.0, 38.0)] * 6
    chain = [Link(i, i + 1, "condition", False, None) for i in range(4)]
    graph = proper_layering(
        [0, 1, 2, 3, 4, 5],
        sizes,
        [*chain, Link(4, 5, "writes", False, None), Link(0, 5, "writes", False, None)],
    )
    minimise_crossings(graph)
    place_ports(graph)
    middle = assign_coordinates(graph)
    passing = [v for v, kind in enumerate(graph.kind) if kind == "dummy"]
    assert len({round(middle[v], 3) for v in passing}) == 1
