"""Layers are assigned so that the total length of the arcs is minimal."""

from itertools import product

import pytest
from hypothesis import given
from hypothesis import strategies as st

from ravestate.draw.simplex import Arc, network_simplex


@st.composite
def connected(draw: st.DrawFn, most: int) -> tuple[int, list[Arc]]:
    count = draw(st.integers(1, most))
    weight, length = st.integers(1, 8), st.integers(1, 2)
    arcs = [(draw(st.integers(0, v - 1)), v, draw(weight), draw(length)) for v in range(1, count)]
    for u, v in draw(st.lists(st.tuples(st.integers(0, most), st.integers(0, most)), max_size=2 * most)):
        if u < v < count:
            arcs.append((u, v, draw(weight), draw(length)))
    order = draw(st.permutations(range(count)))  # shuffle, so that numbers say nothing about layers
    return count, [(order[u], order[v], w, length) for u, v, w, length in arcs]


def cost(rank: list[int], arcs: list[Arc]) -> int:
    return sum(weight * (rank[v] - rank[u]) for u, v, weight, _ in arcs)


@given(connected(30))
def test_every_arc_spans_its_minimum_length_and_layers_begin_at_zero(graph: tuple[int, list[Arc]]) -> None:
    count, arcs = graph
    rank = network_simplex(count, arcs)
    assert min(rank) == 0
    assert all(rank[v] - rank[u] >= length for u, v, _, length in arcs)


@given(connected(4))
def test_the_total_length_of_the_arcs_is_minimal(graph: tuple[int, list[Arc]]) -> None:
    count, arcs = graph
    best = min(
        cost(list(rank), arcs)
        for rank in product(range(2 * count - 1), repeat=count)
        if all(rank[v] - rank[u] >= length for u, v, _, length in arcs)
    )
    assert cost(network_simplex(count, arcs), arcs) == best


def test_an_empty_graph_has_no_layers() -> None:
    assert network_simplex(0, []) == []


def test_a_cycle_is_refused() -> None:
    with pytest.raises(ValueError, match="cycle"):
        network_simplex(2, [(0, 1, 1, 1), (1, 0, 1, 1)])


def test_a_graph_that_is_not_connected_is_refused() -> None:
    with pytest.raises(ValueError, match="not connected"):
        network_simplex(2, [])
