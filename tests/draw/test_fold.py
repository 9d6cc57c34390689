"""Folding makes each module one node."""

from draw.examples import games, prompting
from ravestate.draw.build import build
from ravestate.draw.fold import fold
from ravestate.draw.graph import Diagram, Edge, EdgeKind, Node
from ravestate.draw.svg import svg

RULES = [*games().rules, *prompting().rules]


def test_folding_makes_each_module_one_node_with_the_number_of_its_rules() -> None:
    folded = fold(build(RULES))
    assert [(node.id, node.kind, node.note) for node in folded.nodes] == [
        ("module demo", "module", "8 rules"),
        ("module prompt", "module", "3 rules"),
    ]
    assert "module prompt (3 rules)" in svg(folded)


def test_several_edges_between_two_modules_become_one_edge_of_the_strongest_kind() -> None:
    nodes = (Node("s", "slot", "s", "m"), Node("r", "rule", "r", "n"))
    kinds: tuple[EdgeKind, ...] = ("reads", "condition_detached", "writes", "condition", "emits")
    edges = tuple(Edge("s", "r", kind, "label") for kind in kinds)
    assert fold(Diagram(nodes, edges)).edges == (Edge("module m", "module n", "writes"),)
    assert fold(Diagram(nodes, edges), {"n"}).edges == (Edge("module m", "r", "writes"),)
    assert fold(Diagram(nodes, edges), {"m", "n"}).edges == edges


def test_an_unfolded_module_keeps_its_own_nodes_and_junctions() -> None:
    whole = build(RULES)
    folded = fold(whole, {"demo"})
    assert [node for node in folded.nodes if node.kind != "module"] == list(build(games().rules).nodes)
    assert fold(whole, {"demo", "prompt"}) == whole
