"""In the diagram, modules can be folded. No node is lost, and no two nodes overlap."""

import itertools

import ravestate as rs
from board.looking import gossip
from modules.platform.webio.visit import parrot
from ravestate.board.description import describe
from ravestate.board.inspector import drawing
from ravestate.draw.fold import fold
from ravestate.modules import hibye, idle


def test_folding_leaves_one_node_for_each_module_and_no_edge_within_a_module() -> None:
    whole = describe(rs.compile(gossip, parrot, idle, hibye)).diagram
    folded = fold(whole, ())
    modules = {node.module for node in whole.nodes if node.module}
    assert {node.id for node in folded.nodes} == {f"module {name}" for name in modules}
    assert all(edge.source != edge.target for edge in folded.edges)
    assert fold(whole, modules) == whole


def test_a_folded_module_says_how_many_rules_it_has() -> None:
    folded = fold(describe(rs.compile(gossip, parrot)).diagram, {"gossip"})
    notes = {node.id: node.note for node in folded.nodes if node.id.startswith("module ")}
    assert notes["module parrot"] == "3 rules"
    assert notes["module rawio"] == "no rules"
    junctions = [node for node in folded.nodes if node.kind in ("and", "or")]
    assert not junctions  # folding removes the junctions of a module


def test_the_layout_of_120_rules_has_no_overlapping_nodes() -> None:
    module = rs.Module("large")
    heard, said = module.slot("heard", ""), module.slot("said", "")
    signals = [heard.changed]
    for number in range(120):
        signal = module.signal(f"signal_{number}")
        module.rule(
            when=signals[number // 2] & signals[number // 3], writes=said if number % 5 == 0 else (), emits=signal,
            name=f"rule_{number}",
        )(lambda ctx: None)  # fmt: skip
        signals.append(signal)
    drawn = drawing(describe(rs.compile(module)).diagram, ["large"])
    assert len([node for node in drawn.nodes if node.kind == "rule"]) == 120
    for one, other in itertools.combinations([node.box for node in drawn.nodes], 2):
        apart = (
            one[0] + one[2] <= other[0] or other[0] + other[2] <= one[0]
            or one[1] + one[3] <= other[1] or other[1] + other[3] <= one[1]
        )  # fmt: skip
        assert apart, (one, other)
    assert all(len(edge.points) >= 2 for edge in drawn.edges)
