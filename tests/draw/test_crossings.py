"""The order of the vertices in their layers is chosen so that few lines cross."""

from hypothesis import given
from hypothesis import strategies as st

from ravestate.draw.crossings import count_crossings, minimise_crossings
from ravestate.draw.layered import Link, proper_layering

pairs = st.lists(st.tuples(st.integers(0, 5), st.integers(6, 11)), max_size=20)


@given(pairs)
def test_count_crossings_agrees_with_a_comparison_of_all_pairs(segments: list[tuple[int, int]]) -> None:
    after: list[list[int]] = [[] for _ in range(12)]
    for u, v in segments:
        after[u].append(v)
    expected = sum((a < c and b > d) for a, b in segments for c, d in segments)
    assert count_crossings([list(range(6)), list(range(6, 12))], after) == expected


@given(pairs)
def test_minimising_never_adds_crossings_and_loses_no_vertex(segments: list[tuple[int, int]]) -> None:
    links = [Link(u, v, "writes", False, None) for u, v in segments]
    graph = proper_layering([0] * 6 + [1] * 6, [(10.0, 10.0)] * 12, links)
    after = graph.neighbours()[1]
    before = count_crossings(graph.order, after)
    minimise_crossings(graph)
    assert count_crossings(graph.order, after) <= before
    assert [sorted(layer) for layer in graph.order] == [list(range(6)), list(range(6, 12))]


def test_two_lines_that_cross_are_untangled() -> None:
    links = [Link(0, 3, "writes", False, None), Link(1, 2, "writes", False, None)]
    graph = proper_layering([0, 0, 1, 1], [(10.0, 10.0)] * 4, links)
    minimise_crossings(graph)
    assert count_crossings(graph.order, graph.neighbours()[1]) == 0
