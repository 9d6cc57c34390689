"""Lines and labels get their own vertices in the layers that they pass."""

import pytest

from ravestate.draw.graph import EdgeKind
from ravestate.draw.layered import Link, proper_layering
from ravestate.draw.style import EDGE_STYLES


def link(low: int, high: int, label: tuple[float, float] | None = None, is_reversed: bool = False) -> Link:
    return Link(low, high, "condition", is_reversed, label)


def test_a_long_line_has_a_dummy_in_each_layer_that_it_passes() -> None:
    graph = proper_layering([0, 1, 2, 3], [(10.0, 10.0)] * 4, [link(0, 1), link(1, 2), link(2, 3), link(0, 3)])
    assert [graph.kind[v] for v in range(4, len(graph.kind))] == ["dummy", "dummy"]
    assert len(graph.chains[3]) == 3


def test_long_lines_from_one_port_share_their_dummies() -> None:
    graph = proper_layering([0, 3, 3, 2, 1], [(10.0, 10.0)] * 5, [link(0, 4), link(0, 3), link(0, 1), link(0, 2)])
    assert graph.kind.count("dummy") == 2
    assert graph.chains[2][:2] == graph.chains[3][:2]
    assert graph.chains[1][0] == graph.chains[2][0]


@pytest.mark.parametrize("kind", EDGE_STYLES)
def test_long_lines_to_one_port_share_their_dummies_if_they_are_solid(kind: EdgeKind) -> None:
    links = [Link(low, 3, kind, False, None) for low in range(3)]
    graph = proper_layering([0, 0, 0, 3], [(10.0, 10.0)] * 4, links)
    assert graph.kind.count("dummy") == (6 if EDGE_STYLES[kind].dashes else 2)


def test_a_label_has_its_own_vertex_next_to_the_head_of_the_arrow() -> None:
    graph = proper_layering([0, 3, 3], [(10.0, 10.0)] * 3, [link(0, 1, (30.0, 16.0)), link(0, 2)])
    label = graph.labels[0]
    assert label is not None and graph.labels[1] is None
    assert (graph.layer[label], graph.kind[label], graph.width[label]) == (2, "label", 30.0)
    back = proper_layering([0, 3], [(10.0, 10.0)] * 2, [link(0, 1, (30.0, 16.0), is_reversed=True)])
    assert back.labels[0] is not None and back.layer[back.labels[0]] == 1
