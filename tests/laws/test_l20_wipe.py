"""L20: wiping a signal withdraws its live spikes and their descendants. `keep="latest"` withdraws older spikes."""

from typing import Any

import ravestate as rs
from laws.short import births, drops, emitter, hearer, outcomes, output, writer, written
from ravestate.engine.events import Wipe
from scenarios.driver import Driver


def test_a_wiped_spike_is_given_up(play: Any) -> None:
    m = rs.Module("m")
    a, b, out = m.signal("a"), m.signal("b"), output(m)
    writer(m, "both", a & b, out)
    with play(m) as sim:
        sim.emit(a)
        sim.emit(a)
        sim.wipe(a)
        assert [dropped.spike for dropped in drops(sim, a)] == [born.spike for born in births(sim, a)]
        assert sim.snapshot()["activations"] == []
        sim.emit(b)
        assert written(sim, out) == []
        sim.emit(a)
        assert written(sim, out) == ["both"]


def test_descendants_of_a_wiped_spike_are_withdrawn(play: Any) -> None:
    m = rs.Module("m")
    i, x, y, never = m.signal("i"), m.signal("x"), m.signal("y"), m.signal("never")
    emitter(m, "one", i, x)
    emitter(m, "two", x, y)
    for signal in (i, x, y):
        hearer(m, f"hold_{signal.name[-1]}", signal & never, signal, [])
    with play(m) as sim:
        sim.emit(i)
        assert len(sim.snapshot()["spikes"]) == 3
        sim.wipe(i)
        assert sim.snapshot()["spikes"] == []
        assert all(len(drops(sim, signal)) == 1 for signal in (i, x, y))


def test_wiping_a_signal_leaves_spikes_of_other_causes(play: Any) -> None:
    m = rs.Module("m")
    i, x, never = m.signal("i"), m.signal("x", input=True), m.signal("never")
    emitter(m, "one", i, x)
    hearer(m, "hold_i", i & never, i, [])
    hearer(m, "hold_x", x & never, x, [])
    with play(m) as sim:
        sim.emit(x)
        sim.emit(i)
        sim.wipe(i)
        assert [spike["id"] for spike in sim.snapshot()["spikes"]] == [births(sim, x)[0].spike]


def interrupted(m: rs.Module, when: rs.Condition, out: rs.Slot[str], ends: list[str]) -> None:
    @m.rule(when=when, writes=out)
    async def slow(ctx: Any) -> None:
        try:
            await ctx.sleep(10.0)
            ctx[out] = "slow"
        finally:
            ends.append(f"{ctx.now:g}")


def test_a_running_rule_that_stands_on_a_wiped_spike_is_cancelled(play: Any) -> None:
    m = rs.Module("m")
    i, out, ends = m.signal("i"), output(m), list[str]()
    interrupted(m, i, out, ends)
    with play(m) as sim:
        sim.emit(i)
        sim.advance(2.0)
        sim.wipe(i)
        sim.advance(20.0)
        assert (ends, written(sim, out), sim.failures) == (["2"], [], [])
        assert outcomes(sim) == [("slow", "wiped")]


def test_a_running_rule_that_stands_on_a_descendant_is_cancelled(play: Any) -> None:
    m = rs.Module("m")
    i, x, out, ends = m.signal("i"), m.signal("x"), output(m), list[str]()
    emitter(m, "cause", i, x)
    hearer(m, "hold", i & m.signal("never"), i, [])
    interrupted(m, x, out, ends)
    with play(m) as sim:
        sim.emit(i)
        sim.advance(2.0)
        sim.wipe(i)
        sim.advance(20.0)
        assert (ends, written(sim, out)) == (["2"], [])


def test_a_descendant_is_withdrawn_even_if_no_activation_holds_the_wiped_cause(play: Any) -> None:
    m = rs.Module("m")
    i, x, never, out = m.signal("i"), m.signal("x"), m.signal("never", input=True), output(m)
    emitter(m, "cause", i, x)
    writer(m, "both", x & never, out)
    with play(m) as sim:
        sim.emit(i)
        sim.wipe(i)
        assert sim.snapshot()["spikes"] == []
        sim.emit(never)
        assert written(sim, out) == []


def test_another_rule_can_answer_the_input_if_a_cancelled_rule_has_written_nothing(play: Any) -> None:
    m = rs.Module("m")
    i, x, out, ends = m.signal("i"), m.signal("x"), output(m), list[str]()
    emitter(m, "cause", i, x)
    interrupted(m, x, out, ends)
    writer(m, "otherwise", i, out)
    with play(m) as sim:
        sim.emit(i)
        sim.advance(2.0)
        sim.wipe(x)
        assert (ends, written(sim, out)) == (["2"], ["otherwise"])


def test_a_rule_that_runs_for_another_cause_continues(play: Any) -> None:
    m = rs.Module("m")
    i, j, out, ends = m.signal("i"), m.signal("j"), output(m), list[str]()
    interrupted(m, i, out, ends)
    with play(m) as sim:
        sim.emit(i)
        sim.emit(j)
        sim.wipe(j)
        sim.advance(20.0)
        assert (ends, written(sim, out)) == (["10"], ["slow"])


def test_wiping_does_not_end_the_run_of_a_plain_function() -> None:
    m = rs.Module("m")
    i, out = m.signal("i"), output(m)

    @m.rule(when=i, writes=out)
    def act(ctx: Any) -> None:
        sim.receive(Wipe(i.name))  # from outside, while it runs
        ctx[out] = "plain"

    with Driver(m) as sim:
        sim.emit(i)
        assert (written(sim, out), sim.fired) == (["plain"], ["m:act"])


def test_a_rule_can_wipe_a_signal(play: Any) -> None:
    m = rs.Module("m")
    a, b, forget, out = m.signal("a"), m.signal("b"), m.signal("forget"), output(m)
    writer(m, "both", a & b, out)

    @m.rule(when=forget)
    async def wipe(ctx: Any) -> None:
        ctx.wipe(a)

    with play(m) as sim:
        sim.emit(a)
        sim.emit(forget)
        sim.emit(b)
        assert written(sim, out) == []


def test_a_rule_that_wipes_its_own_spike_is_not_cancelled(play: Any) -> None:
    m = rs.Module("m")
    a, out = m.signal("a"), output(m)

    @m.rule(when=a, writes=out)
    async def wipe(ctx: Any) -> None:
        ctx.wipe(a)
        await ctx.sleep(1.0)
        ctx[out] = "wiped"

    with play(m) as sim:
        sim.emit(a)
        sim.advance(2.0)
        assert (written(sim, out), sim.failures) == (["wiped"], [])


def test_a_slot_can_keep_only_its_latest_change(play: Any) -> None:
    m = rs.Module("m")
    pose, go, heard = m.slot("pose", 0, keep="latest", input=True), m.signal("go"), list[Any]()
    hearer(m, "look", pose.changed & go, pose.changed, heard)
    with play(m) as sim:
        for value in (1, 2, 3):
            sim.put(pose, value)
        assert len(sim.explain("m:look").activations) == 1
        sim.emit(go)
        sim.emit(go)
        assert heard == [3]


def test_a_signal_can_keep_only_its_latest_spike(play: Any) -> None:
    m = rs.Module("m")
    pose, go, heard = m.signal("pose", payload=int, keep="latest"), m.signal("go"), list[Any]()
    hearer(m, "look", pose & go, pose, heard)
    with play(m) as sim:
        for value in (1, 2, 3):
            sim.emit(pose, value)
        sim.emit(go)
        sim.emit(go)
        assert heard == [3]


def test_effects_of_a_wiped_run_that_cleans_up_are_withdrawn_too(play: Any) -> None:
    m = rs.Module("m")
    i, x, heard = m.signal("i"), m.signal("x"), list[Any]()

    @m.rule(when=i, emits=x)
    async def slow(ctx: Any) -> None:
        try:
            await ctx.sleep(10.0)
        finally:
            ctx.emit(x, "late")

    hearer(m, "hear", x, x, heard)
    with play(m) as sim:
        sim.emit(i)
        sim.advance(1.0)
        sim.wipe(i)
        sim.advance(20.0)
        assert (heard, births(sim, x)) == ([], [])
