"""Reversing a few edges makes a graph acyclic. Weak edges are reversed rather than strong edges."""

from hypothesis import given
from hypothesis import strategies as st

from ravestate.draw.acyclic import STRONG, feedback_arcs

edges_of_ten = st.lists(
    st.tuples(st.integers(0, 9), st.integers(0, 9), st.sampled_from((1, 2, STRONG, 3 * STRONG))).filter(
        lambda edge: edge[0] != edge[1]
    ),
    max_size=40,
)


def has_cycle(edges: list[tuple[int, int]]) -> bool:
    left = list(edges)
    while left:
        entered = {v for _, v in left}
        kept = [(u, v) for u, v in left if u in entered]
        if len(kept) == len(left):
            return True
        left = kept
    return False


@given(edges_of_ten)
def test_reversing_the_feedback_arcs_leaves_no_cycle(edges: list[tuple[int, int, int]]) -> None:
    turned = feedback_arcs(10, edges)
    assert not has_cycle([(v, u) if t else (u, v) for (u, v, _), t in zip(edges, turned, strict=True)])


@given(edges_of_ten)
def test_an_edge_outside_of_all_cycles_keeps_its_direction(edges: list[tuple[int, int, int]]) -> None:
    forward = [(u, v, w) for u, v, w in edges if u < v]
    assert not any(feedback_arcs(10, forward))


@given(edges_of_ten)
def test_a_strong_edge_keeps_its_direction_if_weak_edges_can_break_the_cycle(edges: list[tuple[int, int, int]]) -> None:
    forward = [(u, v, STRONG) for u, v, w in edges if u < v and w >= STRONG]
    weak = [(u, v, 1) for u, v, w in edges if w < STRONG]
    assert not any(feedback_arcs(10, [*forward, *weak])[: len(forward)])


def test_a_cycle_is_broken_at_its_weak_edge() -> None:
    assert feedback_arcs(3, [(0, 1, STRONG), (1, 2, STRONG), (2, 0, 1)]) == [False, False, True]
    assert feedback_arcs(3, [(2, 0, 1), (0, 1, STRONG), (1, 2, STRONG)]) == [True, False, False]
