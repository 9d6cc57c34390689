"""L10: rules exclude each other for a cause if, and only if, they share a written slot and a causal group."""

from typing import Any

import ravestate as rs
from laws.short import emitter, hearer, output, started, writer, written


def conflicting(m: rs.Module) -> list[tuple[str, str]]:
    return [(c.first.split(":")[1], c.second.split(":")[1]) for c in rs.compile(m).conflicts()]


def test_rules_that_share_a_slot_and_a_cause_exclude_each_other(play: Any) -> None:
    m = rs.Module("m")
    i, x, out = m.signal("i"), m.signal("x"), output(m)
    emitter(m, "cause", i, x)
    writer(m, "specific", x, out)
    writer(m, "general", i, out)
    assert conflicting(m) == [("specific", "general")]
    with play(m) as sim:
        sim.emit(i)
        sim.advance(10.0)
        assert written(sim, out) == ["specific"]


def test_rules_that_share_one_of_several_slots_exclude_each_other(play: Any) -> None:
    m = rs.Module("m")
    i, out, face, arm = m.signal("i"), output(m), output(m, "face"), output(m, "arm")
    writer(m, "first", i, out, face)
    writer(m, "second", i, face, arm)
    assert conflicting(m) == [("first", "second")]
    with play(m) as sim:
        sim.emit(i)
        sim.advance(10.0)
        assert (written(sim, out), written(sim, face), written(sim, arm)) == (["first"], ["first"], [])


def test_rules_that_share_only_a_cause_do_not_exclude_each_other(play: Any) -> None:
    m = rs.Module("m")
    i, out, face = m.signal("i"), output(m), output(m, "face")
    writer(m, "speak", i, out)
    writer(m, "smile", i, face)
    assert conflicting(m) == []
    with play(m) as sim:
        sim.emit(i)
        assert sim.fired == ["m:speak", "m:smile"]


def test_rules_that_share_only_a_slot_do_not_exclude_each_other(play: Any) -> None:
    m = rs.Module("m")
    i, j, out = m.signal("i"), m.signal("j"), output(m)
    writer(m, "one", i, out, after=2.0)
    writer(m, "other", j, out, after=2.0)
    assert conflicting(m) == []
    with play(m) as sim:
        sim.emit(i)
        sim.advance(1.0)
        sim.emit(j)
        sim.advance(10.0)
        assert started(sim) == [(0.0, "one"), (1.0, "other")]
        assert written(sim, out) == ["one", "other"]


def test_rules_that_exclude_each_other_for_one_cause_run_together_for_different_causes(play: Any) -> None:
    m = rs.Module("m")
    i, x, out = m.signal("i"), m.signal("x", input=True), output(m)
    emitter(m, "cause", i, x)
    writer(m, "specific", x, out, after=2.0)
    writer(m, "general", i, out, after=2.0)
    with play(m) as sim:
        sim.emit(x)
        sim.emit(i)
        assert started(sim) == [(0.0, "specific"), (0.0, "cause"), (0.0, "specific")]
        sim.advance(10.0)
        assert written(sim, out) == ["specific", "specific"]


def test_a_rule_with_only_a_detached_constraint_excludes_no_writer_of_its_slot(play: Any) -> None:
    m = rs.Module("m")
    i, out = m.signal("i"), output(m)
    writer(m, "act", i, out)
    writer(m, "look", i.detached(), out)
    assert conflicting(m) == []
    with play(m) as sim:
        sim.emit(i)
        assert sorted(written(sim, out)) == ["act", "look"]


def test_a_rule_on_a_detached_effect_does_not_exclude_a_rule_on_its_origin(play: Any) -> None:
    m = rs.Module("m")
    i, x, out = m.signal("i"), m.signal("x"), output(m)
    emitter(m, "cause", i, x, detached=True)
    writer(m, "later", x, out)
    writer(m, "now", i, out)
    assert conflicting(m) == []
    with play(m) as sim:
        sim.emit(i)
        assert sorted(written(sim, out)) == ["later", "now"]


def test_a_conflict_names_the_winner_and_its_lead() -> None:
    m = rs.Module("m")
    i, x, out = m.signal("i"), m.signal("x"), output(m)
    emitter(m, "cause", i, x)
    writer(m, "general", i, out)
    writer(m, "specific", x, out)
    writer(m, "twin", x, out)
    policy = rs.compile(m)
    found = {c.rules: c for c in policy.conflicts()}
    one, tie = found["m:general", "m:specific"], found["m:specific", "m:twin"]
    assert (one.slots, one.causes, one.winner) == (("m:out",), ("m:i",), "m:specific")
    assert one.margin == round(policy.utility("m:specific") - policy.utility("m:general"), 12)
    assert (tie.tie, tie.winner, tie.causes) == (True, "m:specific", ("m:i", "m:x"))
    assert not one.tie


def test_a_rule_that_writes_nothing_does_not_exclude_other_rules(play: Any) -> None:
    m = rs.Module("m")
    i, x, out, heard = m.signal("i"), m.signal("x"), output(m), list[Any]()
    writer(m, "act", i, out)
    hearer(m, "hear", i, i, heard)
    hearer(m, "hear_too", i, i, heard)
    emitter(m, "cause", i, x)
    assert conflicting(m) == []
    with play(m) as sim:
        sim.emit(i, 1)
        assert sorted(sim.fired) == ["m:act", "m:cause", "m:hear", "m:hear_too"]
        assert heard == [1, 1]


def test_a_rule_that_writes_nothing_runs_only_once_on_the_same_spike(play: Any) -> None:
    m = rs.Module("m")
    a, b, heard = m.signal("a"), m.signal("b"), list[Any]()
    hearer(m, "hear", a & b, b, heard)
    with play(m) as sim:
        sim.emit(a)
        sim.emit(b, 1)
        sim.emit(b, 2)
        assert heard == [1]
        sim.emit(a)
        assert heard == [1, 2]


def test_a_rule_that_writes_nothing_runs_on_every_spike_of_one_cause(play: Any) -> None:
    m = rs.Module("m")
    i, x, heard = m.signal("i"), m.signal("x", payload=int), list[Any]()

    @m.rule(when=i, emits=x)
    async def burst(ctx: Any) -> None:
        for number in range(3):
            ctx.emit(x, number)

    hearer(m, "hear", x, x, heard)
    with play(m) as sim:
        sim.emit(i)
        assert heard == [0, 1, 2]
