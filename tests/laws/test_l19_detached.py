"""L19: a detached constraint only looks. Effects of a detached rule have no parents, so its loops can be endless."""

from typing import Any

import ravestate as rs
from laws.short import at_rest, births, emitter, hearer, moments, output, resigner, started, writer, written


def test_a_detached_constraint_needs_no_consent(play: Any) -> None:
    m = rs.Module("m")
    i, out = m.signal("i"), output(m)
    resigner(m, "busy", i, out, after=5.0)
    writer(m, "look", i.detached(), out)
    with play(m) as sim:
        sim.emit(i)
        assert moments(sim, out) == [(0.0, "look")]


def test_a_detached_constraint_consumes_nothing(play: Any) -> None:
    m = rs.Module("m")
    i, x, out = m.signal("i"), m.signal("x"), output(m)
    writer(m, "look", i.detached(), out)
    emitter(m, "cause", i, x, after=1.0)
    writer(m, "answer", i & x, out)
    with play(m) as sim:
        sim.emit(i)
        sim.advance(5.0)
        assert moments(sim, out) == [(0.0, "look"), (1.0, "answer")]


def test_a_detached_constraint_joins_no_groups(play: Any) -> None:
    m = rs.Module("m")
    i, j, x = m.signal("i"), m.signal("j"), m.signal("x")
    emitter(m, "join", i & j.detached(), x)
    with play(m) as sim:
        sim.emit(j)
        sim.emit(i)
        groups = {signal.name: births(sim, signal)[0].group for signal in (i, j, x)}
        assert groups["m:x"] == groups["m:i"] != groups["m:j"]


def test_a_detached_constraint_can_look_at_one_spike_more_than_once(play: Any) -> None:
    m = rs.Module("m")
    i, j, heard = m.signal("i"), m.signal("j"), list[Any]()
    hearer(m, "look", i & j.detached(), i, heard)
    with play(m) as sim:
        sim.emit(j)
        for number in range(3):
            sim.emit(i, number)
        assert heard == [0, 1, 2]
        sim.advance(5.0)
        sim.emit(i, 3)
        assert heard == [0, 1, 2]  # now, the spike of j is too old


def test_a_detached_constraint_can_look_at_a_consumed_spike(play: Any) -> None:
    m = rs.Module("m")
    i, j, out = m.signal("i"), m.signal("j"), output(m)
    writer(m, "answer", j, out)
    writer(m, "look", i & j.detached(), out)
    with play(m) as sim:
        sim.emit(j)
        sim.advance(1.0)
        sim.emit(i)
        assert moments(sim, out) == [(0.0, "answer"), (1.0, "look")]


def test_a_rule_with_only_a_detached_constraint_runs_once_on_each_spike(play: Any) -> None:
    m = rs.Module("m")
    i, heard = m.signal("i"), list[Any]()
    hearer(m, "look", i.detached(), i, heard)
    with play(m) as sim:
        sim.emit(i, 1)
        sim.emit(i, 2)
        sim.advance(10.0)
        assert heard == [1, 2]


def test_effects_of_a_detached_rule_have_no_parents(play: Any) -> None:
    m = rs.Module("m")
    i, x, text = m.signal("i"), m.signal("x"), m.slot("text", "")

    @m.rule(when=i, emits=x, writes=text, detached=True)
    async def cause(ctx: Any) -> None:
        ctx.emit(x)
        ctx[text] = "caused"

    with play(m) as sim:
        sim.emit(i)
        effects = [*births(sim, x), *births(sim, text.changed)]
        assert [born.parents for born in effects] == [(), ()]
        assert births(sim, i)[0].group not in {born.group for born in effects}


def test_a_detached_rule_consumes_spikes_like_any_other_rule(play: Any) -> None:
    m = rs.Module("m")
    i, out = m.signal("i"), output(m)
    writer(m, "first", i, out, detached=True)
    writer(m, "second", i, out)
    with play(m) as sim:
        sim.emit(i)
        sim.advance(10.0)
        assert written(sim, out) == ["first"]


def test_a_loop_through_a_detached_rule_can_run_for_ever(play: Any) -> None:
    m = rs.Module("m")
    tick, out = m.signal("tick", input=True), output(m)

    @m.rule(when=tick.min_age(1.0), emits=tick, writes=out, detached=True)
    async def again(ctx: Any) -> None:
        ctx[out] = "tick"
        ctx.emit(tick)

    with play(m) as sim:
        sim.emit(tick)
        sim.advance(50.0)
        assert moments(sim, out) == [(float(second), "tick") for second in range(1, 51)]


def test_only_one_rule_of_a_group_writes_a_slot(play: Any) -> None:
    m = rs.Module("m")
    i, out = m.signal("i"), output(m)
    signals = [m.signal(f"x{number}") for number in range(5)]
    for number, signal in enumerate(signals):
        emitter(m, f"cause_{number}", i, signal, after=float(number))
        writer(m, f"write_{number}", signal, out, weight=1.0 + number / 10)
    with play(m) as sim:
        sim.emit(i)
        sim.advance(60.0)
        assert len(written(sim, out)) == 1


def test_a_loop_over_a_slot_ends(play: Any) -> None:
    m = rs.Module("m")
    count = m.slot("count", 0, input=True)

    @m.rule(when=count.changed, writes=count)
    async def count_up(ctx: Any) -> None:
        ctx[count] += 1

    with play(m) as sim:
        sim.put(count, 10)
        sim.advance(100.0)
        assert sim.read(count) == 11
        assert at_rest(sim)


def test_a_loop_over_two_slots_ends(play: Any) -> None:
    m = rs.Module("m")
    ping, pong = m.slot("ping", 0, input=True), m.slot("pong", 0)

    @m.rule(when=ping.changed, writes=pong)
    async def hit(ctx: Any) -> None:
        ctx[pong] = ctx.payload(ping.changed) + 1

    @m.rule(when=pong.changed, writes=ping)
    async def hit_back(ctx: Any) -> None:
        ctx[ping] = ctx.payload(pong.changed) + 1

    with play(m) as sim:
        sim.put(ping, 1)
        sim.advance(100.0)
        assert (sim.read(pong), sim.read(ping)) == (2, 3)
        assert at_rest(sim)


def test_a_loop_over_signals_ends(play: Any) -> None:
    m = rs.Module("m")
    a, b = m.signal("a", input=True), m.signal("b")
    emitter(m, "hen", a, b)
    emitter(m, "egg", b, a)
    with play(m) as sim:
        sim.emit(a)
        sim.advance(100.0)
        assert [name for _, name in started(sim)] == ["hen", "egg"]
        assert at_rest(sim)
