"""The clock of a context can be halted, set forward and started again, without other effects on the context."""

from __future__ import annotations

import asyncio
import math
from typing import Any

import pytest

import ravestate as rs
from ravestate.engine.trace import Started
from ravestate.runtime.clock import Clock
from ravestate.testing import simulate
from ravestate.testing.virtual_loop import VirtualLoop


class Scene:
    """A clock on a virtual loop, and tasks that sleep by this clock."""

    def __init__(self) -> None:
        self.loop = VirtualLoop()
        self.loop.run_to(7.0)  # so that the clock starts later than its loop
        self.clock = Clock(self.loop)
        self.woken: list[tuple[str, float]] = []

    def sleeper(self, name: str, seconds: float) -> asyncio.Task[None]:
        async def sleep() -> None:
            await self.clock.sleep(seconds)
            self.woken.append((name, self.clock.now()))

        return self.loop.create_task(sleep())

    def pass_by(self, seconds: float) -> None:
        self.loop.run_to(self.loop.time() + seconds)


@pytest.fixture
def scene() -> Scene:
    return Scene()


def test_a_clock_starts_at_zero_and_then_advances_with_its_loop(scene: Scene) -> None:
    assert scene.clock.now() == 0.0
    scene.sleeper("a", 2.0)
    scene.sleeper("b", 1.0)
    scene.pass_by(5.0)
    assert scene.woken == [("b", 1.0), ("a", 2.0)]
    scene.loop.close()


def test_a_sleep_does_not_count_the_time_in_which_the_clock_is_halted(scene: Scene) -> None:
    scene.sleeper("a", 2.0)
    scene.pass_by(0.5)
    scene.clock.halt()
    scene.sleeper("b", 1.0)
    scene.pass_by(10.0)
    assert (scene.clock.now(), scene.woken) == (0.5, [])
    scene.clock.go()
    scene.pass_by(10.0)
    assert scene.woken == [("b", 1.5), ("a", 2.0)]
    assert scene.clock.now() == 10.5
    scene.loop.close()


def test_sleeping_for_nan_seconds_is_refused(scene: Scene) -> None:
    with pytest.raises(ValueError, match="nan"):
        scene.loop.run_until_complete(scene.clock.sleep(math.nan))
    scene.loop.close()


def test_the_clock_can_be_set_forward_only_while_it_is_halted_and_never_back(scene: Scene) -> None:
    scene.sleeper("a", 2.0)
    scene.pass_by(0.5)
    scene.clock.set(3.0)
    assert scene.clock.now() == 0.5
    scene.clock.halt()
    assert scene.clock.next_waking() == 2.0
    scene.clock.set(2.0)
    scene.clock.set(1.0)
    scene.pass_by(0.0)
    assert (scene.clock.now(), scene.woken, scene.clock.next_waking()) == (2.0, [("a", 2.0)], None)
    scene.loop.close()


def test_the_clock_drops_a_sleeper_that_is_cancelled(scene: Scene) -> None:
    task = scene.sleeper("a", 2.0)
    scene.pass_by(0.5)
    task.cancel()
    scene.pass_by(0.0)
    assert scene.clock.next_waking() is None
    scene.clock.halt()
    scene.clock.go()
    scene.pass_by(5.0)
    assert scene.woken == []
    scene.loop.close()


def story() -> tuple[rs.Module, rs.Signal[None], rs.Slot[str]]:
    """Return a module with a rule that thinks about a question for 2 s, and a fallback that waits for this rule."""
    m = rs.Module("m")
    asked, known, said = m.signal("asked"), m.signal("known"), m.slot("said", "", always=True)

    @m.rule(when=asked, emits=known)
    async def think(ctx: rs.RuleContext) -> None:
        await ctx.sleep(2.0)
        ctx.emit(known)

    @m.rule(when=known, writes=said)
    async def answer(ctx: rs.RuleContext) -> None:
        ctx[said] = f"answer at {ctx.now:g}"

    @m.rule(when=asked, writes=said)
    async def fallback(ctx: rs.RuleContext) -> None:
        ctx[said] = "fallback"

    return m, asked, said


def test_a_paused_context_accepts_events_but_runs_no_rules() -> None:
    m, asked, said = story()
    with simulate(m) as sim:
        sim.context.pause()
        assert sim.context.paused
        sim.emit(asked)
        sim.advance(60.0)
        assert (sim.now, sim.fired, sim.read(said)) == (0.0, [], "")
        assert {a["state"] for a in sim.snapshot()["activations"]} == {"ready"}
        sim.context.resume()
        sim.advance(1.0)
        assert sim.fired == []
        sim.advance(1.0)
        assert sim.read(said) == "answer at 2"


def test_each_step_of_a_paused_context_goes_to_the_next_moment_at_which_something_happens() -> None:
    m, asked, said = story()
    with simulate(m) as sim:
        sim.context.pause()
        sim.emit(asked)
        seen: list[tuple[float, str, str]] = []
        for _ in range(4):
            assert sim.context.step()
            sim.settle()
            states = {a["rule"]: a["state"] for a in sim.snapshot()["activations"]}
            seen.append((sim.now, states.get("m:think", ""), states.get("m:fallback", "")))
        assert seen == [
            (0.0, "running", "ready"),
            (0.0, "running", "waiting"),
            (2.0, "", "waiting"),
            (2.0, "", ""),
        ]
        assert sim.read(said) == "answer at 2"
        while sim.context.step():  # until the old spikes are dropped
            sim.settle()
        assert not sim.context.step()


def test_a_pause_does_not_change_the_trace() -> None:
    def tell(pauses: bool) -> list[str]:
        m, asked, _ = story()
        with simulate(m) as sim:
            sim.emit(asked)
            for _ in range(5):
                if pauses:
                    sim.context.pause()
                    sim.advance(3.0)
                    sim.context.resume()
                sim.advance(0.5)
            return [repr(record) for record in sim.trace]

    assert tell(pauses=True) == tell(pauses=False)


def test_a_paused_context_still_runs_its_rules_for_shutdown() -> None:
    m = rs.Module("m")
    ended: list[float] = []

    @m.rule(when=rs.shutdown)
    async def end(ctx: rs.RuleContext) -> None:
        await ctx.sleep(1.0)
        ended.append(ctx.now)

    with simulate(m) as sim:
        sim.context.pause()
        sim.advance(5.0)
    assert ended == [1.0]


def test_observers_can_be_added_and_removed_while_a_context_runs() -> None:
    m, asked, _ = story()
    first: list[Any] = []
    second: list[Any] = []
    with simulate(m, trace=False) as sim:
        leave_first = sim.context.observe(first.append)
        sim.emit(asked)
        leave_second = sim.context.observe(second.append)
        sim.advance(3.0)
        assert first[-len(second) :] == second != []
        assert [r.time for r in first if isinstance(r, Started)] == [0.0, 2.0]
        leave_first()
        counts = len(first), len(second)
        sim.emit(asked)
        assert len(first) == counts[0]
        assert len(second) > counts[1]
        leave_second()
        leave_second()  # a second call has no effect
        counts = len(first), len(second)
        sim.advance(3.0)
        assert (len(first), len(second)) == counts


def test_a_task_can_step_a_paused_context() -> None:
    m, asked, said = story()

    async def talk() -> str:
        async with rs.Context(m) as context:
            await asyncio.sleep(0)
            context.pause()
            context.emit(asked)
            for _ in range(6):
                context.step()
                await asyncio.sleep(0)
            return context.read(said)

    assert asyncio.run(talk()).startswith("answer at 2")


def test_a_driven_clock_never_runs_backwards_when_it_starts_again(scene: Scene) -> None:
    scene.clock.drive(1.0)
    scene.clock.halt()
    scene.clock.set(5.0)
    assert scene.clock.now() == 5.0
    scene.clock.go()
    assert scene.clock.now() == 5.0
    scene.clock.drive(3.0)  # the driver is behind, so the clock waits for it
    assert scene.clock.now() == 5.0
    scene.clock.drive(6.0)
    assert scene.clock.now() == 6.0
    scene.loop.close()


def test_a_driven_clock_advances_only_when_a_rule_sets_it() -> None:
    m = rs.Module("m")
    tick = m.signal("tick", payload=float)
    go = m.signal("go")
    late: list[float] = []
    slept: list[float] = []

    @m.rule(when=tick.max_age(None))
    async def drive(ctx: rs.RuleContext) -> None:
        ctx.drive_clock(ctx.payload(tick))

    @m.rule(when=go.min_age(2.0))
    async def after_two_seconds(ctx: rs.RuleContext) -> None:
        late.append(ctx.now)

    @m.rule(when=go)
    async def sleep(ctx: rs.RuleContext) -> None:
        await ctx.sleep(5.0)
        slept.append(ctx.now)

    async def main() -> None:
        others = Clock(asyncio.get_running_loop())  # this clock advances with the loop, not with the context
        async with rs.Context(m) as context:

            async def at(time: float) -> None:
                context.emit(tick, time)
                await others.sleep(100.0)

            await at(10.0)
            assert context.now == 10.0
            context.emit(go)
            await at(11.9)
            assert (context.now, late, slept) == (11.9, [], [])
            await at(12.5)
            assert (late, slept) == ([12.5], [])
            await at(12.0)  # an earlier time changes nothing
            assert context.now == 12.5
            context.pause()
            await at(15.5)
            assert (context.now, slept) == (12.5, [])
            context.resume()
            await others.sleep(100.0)
            assert context.now == 15.5
            assert slept == [15.5]

    with asyncio.Runner(loop_factory=VirtualLoop) as runner:
        runner.run(main())
