"""Strongly connected components: groups of nodes that lead to each other. The components are in order."""

from hypothesis import given
from hypothesis import strategies as st

from ravestate.policy.components import components


def test_a_component_comes_after_the_components_that_it_leads_to() -> None:
    found = components([[1], [2], [1, 3], []])
    assert [sorted(members) for members in found.members] == [[3], [1, 2], [0]]
    assert found.of == [2, 1, 1, 0]


def test_an_empty_graph_has_no_components() -> None:
    assert components([]).members == []


def test_a_ring_and_a_chain_can_have_any_length() -> None:
    count = 20_000
    ring = components([[(node + 1) % count] for node in range(count)])
    assert [sorted(members) for members in ring.members] == [list(range(count))]
    chain = components([[node + 1] for node in range(count - 1)] + [[]])
    assert chain.members == [[node] for node in reversed(range(count))]


@given(
    st.integers(1, 8).flatmap(lambda n: st.lists(st.lists(st.integers(0, n - 1), max_size=4), min_size=n, max_size=n))
)
def test_nodes_are_in_one_component_if_they_lead_to_each_other(edges: list[list[int]]) -> None:
    nodes = range(len(edges))
    leads = [{node, *edges[node]} for node in nodes]
    for _ in nodes:
        leads = [set[int]().union(*(leads[other] for other in found)) for found in leads]
    found = components(edges)
    for node in nodes:
        assert set(found.members[found.of[node]]) == {n for n in leads[node] if node in leads[n]}
        assert all(found.of[other] <= found.of[node] for other in edges[node])
    assert sorted(node for members in found.members for node in members) == list(nodes)
