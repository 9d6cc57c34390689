"""L7: the effects of a rule, and their causes."""

import ravestate as rs
from laws.short import emitter, hearer, pathways, writer


def test_the_signals_that_a_rule_emits_are_its_effects() -> None:
    m = rs.Module("m")
    go, x, y = m.signal("go"), m.signal("x"), m.signal("y")
    emitter(m, "cause", go, x, y)
    hearer(m, "hear_x", x, x, [])
    hearer(m, "hear_y", y, y, [])
    policy = rs.compile(m)
    assert pathways(policy, "m:hear_x") == {"go x"}
    assert pathways(policy, "m:hear_y") == {"go y"}


def test_all_signals_of_a_slot_that_a_rule_writes_are_its_effects() -> None:
    m = rs.Module("m")
    go = m.signal("go")
    slots = (m.slot("mood", ""), m.flag("lit"), m.collection("people"))
    writer(m, "cause", go, *slots)
    signals = [signal for slot in slots for signal in slot.signals]
    for number, signal in enumerate(signals):
        hearer(m, f"hear_{number}", signal, signal, [])
    policy = rs.compile(m)
    for number, signal in enumerate(signals):
        assert pathways(policy, f"m:hear_{number}") == {f"go {signal.name.split(':', 1)[1]}"}


def test_a_slot_that_a_rule_only_reads_is_not_an_effect() -> None:
    m = rs.Module("m")
    go, mood = m.signal("go"), m.slot("mood", "")
    hearer(m, "look", go, go, [], reads=mood)
    hearer(m, "hear", mood.changed, mood.changed, [])
    assert pathways(rs.compile(m), "m:hear") == {"mood:changed"}


def test_all_constraints_of_a_clause_cause_an_effect_together() -> None:
    m = rs.Module("m")
    a, b, x = m.signal("a"), m.signal("b"), m.signal("x")
    emitter(m, "cause", a & b, x)
    hearer(m, "hear", x, x, [])
    assert pathways(rs.compile(m), "m:hear") == {"a b x"}


def test_each_clause_of_a_rule_is_a_separate_cause() -> None:
    m = rs.Module("m")
    a, b, c, x = m.signal("a"), m.signal("b"), m.signal("c"), m.signal("x")
    emitter(m, "cause", a & b | c, x)
    hearer(m, "hear", x, x, [])
    assert pathways(rs.compile(m), "m:hear") == {"a b x", "c x"}


def test_a_detached_constraint_causes_nothing() -> None:
    m = rs.Module("m")
    a, b, x = m.signal("a"), m.signal("b"), m.signal("x")
    emitter(m, "cause", a & b.detached(), x)
    hearer(m, "hear", x, x, [])
    assert pathways(rs.compile(m), "m:hear") == {"a x"}


def test_the_effects_of_a_detached_rule_have_no_cause() -> None:
    m = rs.Module("m")
    a, x = m.signal("a"), m.signal("x")
    emitter(m, "cause", a, x, detached=True)
    hearer(m, "hear", x, x, [])
    assert pathways(rs.compile(m), "m:hear") == {"x"}
