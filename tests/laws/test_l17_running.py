"""L17: with consent the activation takes its slots in its groups, and its function runs."""

from typing import Any

import ravestate as rs
from laws.short import emitter, output, started, writer, written
from ravestate.testing import simulate


def taken(sim: Any) -> list[dict[str, Any]]:
    return [group["taken"] for group in sim.snapshot()["groups"]]


def test_a_run_takes_its_slots_in_all_of_its_groups(play: Any) -> None:
    m = rs.Module("m")
    i, j, out, face = m.signal("i"), m.signal("j"), output(m), output(m, "face")
    writer(m, "act", i & j, out, face, after=1.0)
    with play(m, trace=False) as sim:
        sim.emit(i)
        sim.emit(j)
        assert taken(sim) == [{"m:out": ["m:act"], "m:face": ["m:act"]}] * 2


def test_a_slot_is_taken_in_no_other_group(play: Any) -> None:
    m = rs.Module("m")
    i, out = m.signal("i"), output(m)
    writer(m, "act", i, out, after=2.0)
    with play(m) as sim:
        sim.emit(i)
        sim.advance(1.0)
        sim.emit(i)
        assert started(sim) == [(0.0, "act"), (1.0, "act")]


def test_rules_that_do_not_exclude_each_other_run_in_parallel(play: Any) -> None:
    m = rs.Module("m")
    i, x, out, face = m.signal("i"), m.signal("x"), output(m), output(m, "face")
    writer(m, "speak", i, out, after=2.0)
    writer(m, "smile", i, face, after=2.0)
    emitter(m, "think", i, x, after=2.0)
    with play(m) as sim:
        sim.emit(i)
        assert sorted(started(sim)) == [(0.0, "smile"), (0.0, "speak"), (0.0, "think")]
        sim.advance(2.0)
        assert sorted(sim.fired) == ["m:smile", "m:speak", "m:think"]


def test_rules_that_exclude_each_other_never_run_together(play: Any) -> None:
    m = rs.Module("m")
    i, out = m.signal("i"), output(m)
    running: list[str] = []

    for name in ("one", "two", "three"):

        async def act(ctx: Any, name: str = name) -> rs.Resign:
            running.append(name)
            await ctx.sleep(1.0)
            assert running == [name]
            running.remove(name)
            return rs.Resign()

        m.rule(when=i, writes=out, name=name)(act)
    with play(m) as sim:
        sim.emit(i)
        sim.advance(10.0)
        assert started(sim) == [(0.0, "one"), (1.0, "two"), (2.0, "three")]
        assert sim.failures == []


def test_a_function_without_async_runs_too() -> None:
    m = rs.Module("m")
    i, out = m.signal("i"), output(m)

    @m.rule(when=i, writes=out)
    def act(ctx: rs.RuleContext) -> None:
        ctx[out] = "plain"

    with simulate(m) as sim:
        sim.emit(i)
        assert (written(sim, out), sim.fired, sim.now) == (["plain"], ["m:act"], 0.0)
