"""A diagram refuses impossible nodes and edges."""

import pytest

from ravestate.draw.graph import Diagram, Edge, Node

A, B = Node("a", "slot", "a"), Node("b", "signal", "b", module="m")


def test_a_name_is_qualified_by_its_module() -> None:
    assert (A.name, B.name) == ("a", "m:b")


def test_two_nodes_with_the_same_id_are_refused() -> None:
    with pytest.raises(ValueError, match="share the id 'a'"):
        Diagram((A, A), ())


def test_an_edge_to_an_unknown_node_is_refused() -> None:
    with pytest.raises(ValueError, match="'c', which is not a node"):
        Diagram((A, B), (Edge("a", "c", "emits"),))


def test_an_edge_to_its_own_source_is_refused() -> None:
    with pytest.raises(ValueError, match="ends where it began"):
        Diagram((A, B), (Edge("a", "a", "emits"),))
