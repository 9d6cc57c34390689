"""L5: conditions become clauses (disjunctive normal form). A rule fires by one clause at a time, in declared order."""

from itertools import pairwise
from typing import Any

import ravestate as rs
from laws.short import emitter, hearer, output, started, written


def signals(m: rs.Module, names: str) -> list[rs.Signal[Any]]:
    return [m.signal(name) for name in names]


def test_conditions_are_brought_into_disjunctive_normal_form_in_order() -> None:
    m = rs.Module("m")
    a, b, c, d, e = signals(m, "abcde")

    async def nothing(ctx: Any) -> None: ...

    conditions = {
        "one": (a, ["a"]),
        "all_of": (a & b & c, ["abc"]),
        "any_of": (c | a | b, ["c", "a", "b"]),
        "left": ((a | b) & c, ["ac", "bc"]),
        "right": (a & (c | b), ["ac", "ab"]),
        "deep": ((a | b) & (c | d & e), ["ac", "ade", "bc", "bde"]),
        "deeper": (a & (b | c & (d | e)), ["ab", "acd", "ace"]),
        "doubled": (a & b | a & b, ["ab"]),
    }
    for name, (condition, _) in conditions.items():
        m.rule(when=condition, name=name)(nothing)
    policy = rs.compile(m)
    for name, (_, expected) in conditions.items():
        clauses = policy.clauses(f"m:{name}")
        assert ["".join(s.name[-1] for s in clause.signals) for clause in clauses] == expected, name


def test_a_rule_fires_by_one_clause_at_a_time(play: Any) -> None:
    m = rs.Module("m")
    begin, a, b = m.signal("begin"), m.signal("a"), m.signal("b")
    out = output(m)
    emitter(m, "cause", begin, a, b)

    @m.rule(when=a | b, writes=out)
    async def act(ctx: Any) -> None:
        ctx[out] = "a" if ctx.payload(a) else "b"

    with play(m) as sim:
        sim.emit(begin)
        sim.advance(10.0)
        assert written(sim, out) == ["a"]  # both clauses have one cause, so only the first one fires, and only once
        sim.emit(b, "x")
        assert written(sim, out) == ["a", "b"]


def test_only_one_of_two_clauses_that_share_a_spike_fires(play: Any) -> None:
    m = rs.Module("m")
    begin, a, b, c = m.signal("begin"), m.signal("a"), m.signal("b"), m.signal("c")
    heard: list[Any] = []
    emitter(m, "cause", begin, a, b, c)
    hearer(m, "hear", (a & c) | (b & c), a, heard)
    with play(m) as sim:
        sim.emit(begin)
        sim.advance(10.0)
        assert heard == ["cause"]


def test_rules_run_in_the_order_of_their_declaration(play: Any) -> None:
    m = rs.Module("m")
    go = m.signal("go")
    names = ["zoe", "adam", "mia", "bob"]
    for name in names:
        hearer(m, name, go, go, [])
    last = rs.Module("last", requires=[m])
    hearer(last, "alone", go, go, [])
    assert list(rs.compile(last).rules) == [*(f"m:{name}" for name in names), "last:alone"]
    with play(last) as sim:
        sim.emit(go)
        assert [name for _, name in started(sim)] == [*names, "alone"]
        assert sim.fired == list(rs.compile(last).rules)


def test_signals_and_slots_are_in_the_order_of_their_declaration() -> None:
    m = rs.Module("m")
    declared = [m.signal(name).name for name in ("z", "a", "k")]
    slots = [m.slot(name, 0).name for name in ("y", "b", "l")]
    policy = rs.compile(m)
    own = [name for name in policy.signals if name in declared]
    assert own == declared
    assert [name for name in policy.slots if name in slots] == slots
    positions = [list(policy.signals).index(f"{name}:changed") for name in slots]
    assert all(a < b for a, b in pairwise(positions))


def test_the_order_of_clauses_decides_between_equals(play: Any) -> None:
    m = rs.Module("m")
    begin, a, b, out = m.signal("begin"), m.signal("a"), m.signal("b"), output(m)
    emitter(m, "cause", begin, b, a)

    @m.rule(when=a | b, writes=out)
    async def act(ctx: Any) -> None:
        ctx[out] = "a" if ctx.payload(a) else "b"

    with play(m) as sim:
        sim.emit(begin)
        assert written(sim, out) == ["a"]
