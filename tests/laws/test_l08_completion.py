"""L8: a causal pathway is a clause plus, recursively, the causes of its non-detached constraints."""

import ravestate as rs
from laws.short import emitter, hearer, pathways, writer


def test_a_clause_of_inputs_is_its_own_pathway() -> None:
    m = rs.Module("m")
    a, b = m.signal("a"), m.signal("b")
    hearer(m, "hear", a & b, a, [])
    assert pathways(rs.compile(m), "m:hear") == {"a b"}


def test_causes_are_added_recursively() -> None:
    m = rs.Module("m")
    signals = [m.signal(f"s{number}") for number in range(5)]
    for number in range(4):
        emitter(m, f"r{number}", signals[number], signals[number + 1])
    hearer(m, "hear", signals[4], signals[4], [])
    policy = rs.compile(m)
    assert pathways(policy, "m:hear") == {"s0 s1 s2 s3 s4"}
    assert pathways(policy, "m:r2") == {"s0 s1 s2"}


def test_every_constraint_is_completed() -> None:
    m = rs.Module("m")
    i, j, x, y = m.signal("i"), m.signal("j"), m.signal("x"), m.signal("y")
    emitter(m, "one", i, x)
    emitter(m, "two", j, y)
    hearer(m, "hear", x & y, x, [])
    assert pathways(rs.compile(m), "m:hear") == {"i j x y"}


def test_a_common_cause_appears_once_on_a_pathway() -> None:
    m = rs.Module("m")
    i, x, y = m.signal("i"), m.signal("x"), m.signal("y")
    emitter(m, "one", i, x)
    emitter(m, "two", i, y)
    hearer(m, "hear", x & y, x, [])
    assert pathways(rs.compile(m), "m:hear") == {"i x y"}


def test_a_detached_constraint_is_on_the_pathway_but_not_completed() -> None:
    m = rs.Module("m")
    i, j, x, y = m.signal("i"), m.signal("j"), m.signal("x"), m.signal("y")
    emitter(m, "one", i, x)
    emitter(m, "two", j, y)
    hearer(m, "hear", x & y.detached(), x, [])
    assert pathways(rs.compile(m), "m:hear") == {"i x y"}


def test_a_signal_with_several_causes_gives_several_pathways() -> None:
    m = rs.Module("m")
    i, j, x, y = m.signal("i"), m.signal("j"), m.signal("x"), m.signal("y")
    for number, (cause, effect) in enumerate(((i, x), (j, x), (i, y), (j, y))):
        emitter(m, f"r{number}", cause, effect)
    hearer(m, "hear", x, x, [])
    hearer(m, "both", x & y, x, [])
    policy = rs.compile(m)
    assert pathways(policy, "m:hear") == {"i x", "j x"}
    assert pathways(policy, "m:both") == {"i x y", "j x y", "i j x y"}


def test_each_clause_has_its_own_pathways() -> None:
    m = rs.Module("m")
    i, x, y = m.signal("i"), m.signal("x"), m.signal("y")
    emitter(m, "one", i, x)
    hearer(m, "hear", x | y, x, [])
    policy = rs.compile(m)
    assert pathways(policy, "m:hear", 0) == {"i x"}
    assert pathways(policy, "m:hear", 1) == {"y"}


def test_cycles_are_cut() -> None:
    m = rs.Module("m")
    a, b = m.signal("a", input=True), m.signal("b")
    emitter(m, "hen", a, b)
    emitter(m, "egg", b, a)
    policy = rs.compile(m)
    assert pathways(policy, "m:egg") == {"a b"}
    assert pathways(policy, "m:hen") == {"a", "a b"}


def test_the_cycle_of_a_rule_that_causes_its_own_signal_is_cut() -> None:
    m = rs.Module("m")
    count = m.slot("count", 0, input=True)
    writer(m, "count_up", count.changed, count)
    assert pathways(rs.compile(m), "m:count_up") == {"count:changed"}


def test_an_input_that_a_rule_also_causes_has_a_pathway_without_this_cause() -> None:
    m = rs.Module("m")
    i, x = m.signal("i"), m.signal("x", input=True)
    text, plain = m.slot("text", "", input=True), m.slot("plain", "")
    emitter(m, "one", i, x)
    writer(m, "two", i, text)
    writer(m, "three", i, plain)
    hearer(m, "hear_x", x, x, [])
    hearer(m, "hear_text", text.changed, text.changed, [])
    hearer(m, "hear_plain", plain.changed, plain.changed, [])
    policy = rs.compile(m)
    assert pathways(policy, "m:hear_x") == {"x", "i x"}
    assert pathways(policy, "m:hear_text") == {"text:changed", "i text:changed"}
    assert pathways(policy, "m:hear_plain") == {"i plain:changed"}
