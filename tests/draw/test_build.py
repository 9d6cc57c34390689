"""A diagram is built from rules: nodes for rules, signals and slots, and edges for what the rules declare."""

from draw.examples import games, prompting, rule
from ravestate.declare.module import Module
from ravestate.declare.settings import setting
from ravestate.draw.build import build
from ravestate.draw.graph import Diagram, Edge


def edges(diagram: Diagram) -> set[tuple[str, str, str, str]]:
    return {(edge.source, edge.target, edge.kind, edge.label) for edge in diagram.edges}


def is_short(text: str) -> bool:
    return len(text) < 5


def test_a_single_constraint_leads_directly_to_its_rule() -> None:
    module = Module("m")
    said, answer = module.slot("input"), module.slot("output")
    rule(module, "echo", said.changed, reads=said, writes=answer)
    assert edges(build(module.rules)) == {
        ("slot m:input", "signal m:input:changed", "emits", ""),
        ("signal m:input:changed", "rule m:echo", "condition", ""),
        ("slot m:input", "rule m:echo", "reads", ""),
        ("rule m:echo", "slot m:output", "writes", ""),
    }


def test_the_constraints_of_a_conjunction_meet_in_one_node() -> None:
    found = build(games().rules)
    assert Edge("signal demo:question", "and demo:OfferGames 0", "condition") in found.edges
    assert Edge("signal demo:games", "and demo:OfferGames 0", "condition") in found.edges
    assert Edge("and demo:OfferGames 0", "rule demo:OfferGames", "condition") in found.edges
    assert [node.kind for node in found.nodes].count("and") == 2
    assert [node.kind for node in found.nodes].count("or") == 0


def test_alternatives_meet_in_a_disjunction_node() -> None:
    module = Module("m")
    a, b, c = (module.signal(name) for name in "abc")
    rule(module, "r", a & b | c)
    assert edges(build(module.rules)) == {
        ("signal m:a", "and m:r 0", "condition", ""),
        ("signal m:b", "and m:r 0", "condition", ""),
        ("and m:r 0", "or m:r 0", "condition", ""),
        ("signal m:c", "or m:r 0", "condition", ""),
        ("or m:r 0", "rule m:r", "condition", ""),
    }


def test_a_detached_rule_has_a_detached_edge_to_its_signal() -> None:
    kinds = {edge.kind for edge in build(prompting().rules).edges if edge.target == "signal prompt:prompted"}
    assert kinds == {"emits_detached"}


def test_a_slot_has_only_the_signals_that_a_rule_uses() -> None:
    module = Module("m")
    lit = module.flag("lit")
    rule(module, "r", lit.true, writes=lit)
    names = [node.name for node in build(module.rules).nodes]
    assert "m:lit:true" in names and "m:lit:changed" not in names and "m:lit:false" not in names


def test_the_edge_of_a_constraint_has_its_ages_and_predicates_as_a_label() -> None:
    module = Module("m")
    a, mood = module.signal("a", str), module.slot("mood")
    found = {
        edge.label
        for number, when in enumerate(
            [
                a.min_age(1.0),
                a.min_age(2.0).max_age(None),
                a.max_age(10.0),
                a.max_age(None),
                a.min_age(setting("wait")).max_age(None),
                a.where(is_short).max_age(0.5),
                a.where(lambda text: text),
                mood.holds(is_short) & a,
            ]
        )
        for edge in build([rule(module, f"r{number}", when)]).edges
    }
    assert found == {
        "",
        "1–5 s",
        "≥ 2 s",
        "≤ 10 s",
        "any age",
        "≥ wait s",
        "≤ 0.5 s, where is_short",
        "where",
        "holds is_short",
    }


def test_detached_constraints_and_interruptions_have_detached_edges() -> None:
    module = Module("m")
    a, b = module.signal("a"), module.signal("b")
    rule(module, "r", a.detached() & b, until=b.min_age(1.0).max_age(None))
    found = edges(build(module.rules))
    assert ("signal m:a", "and m:r 0", "condition_detached", "") in found
    assert ("signal m:b", "rule m:r", "condition_detached", "until ≥ 1 s") in found


def test_the_note_of_a_rule_lists_its_options() -> None:
    module = Module("m")
    a = module.signal("a")
    rule(module, "r", a, weight=1.2, cooldown=30.0, detached=True, background=True)
    rule(module, "s", a)
    notes = {node.label: node.note for node in build(module.rules).nodes if node.kind == "rule"}
    assert notes == {"r": "×1.2, cooldown 30 s, detached, background", "s": ""}


def test_a_rule_and_a_signal_can_have_the_same_name() -> None:
    module = Module("m")
    a = module.signal("a")
    rule(module, "a", a)
    assert [node.id for node in build(module.rules).nodes] == ["signal m:a", "rule m:a"]
