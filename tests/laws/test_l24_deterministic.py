"""L24: the engine is a pure state machine. The same inputs and times give the same effects in any process."""

import os
import random
import subprocess
import sys
import threading
import time
from pathlib import Path
from typing import Any

import pytest

import ravestate as rs
from laws.story import everything, tell
from ravestate.engine.engine import Engine
from ravestate.engine.snapshot import snapshot
from ravestate.engine.trace import Record
from ravestate.runtime.journal import Journal, replay
from ravestate.testing import simulate
from scenarios.driver import Driver

TESTS = Path(__file__).parents[1]


def redo(engine: Engine, log: list[tuple[str, Any, float]]) -> None:
    """Repeat on an engine the calls that another engine has logged."""
    for verb, event, moment in log:
        if verb == "receive":
            engine.receive(event, moment)
        elif verb == "advance":
            engine.advance(moment)
        else:
            engine.effects()


def told(driver: Driver, seed: int = 7) -> Driver:
    with driver:
        tell(driver, seed)
        driver.advance(60.0)
    return driver


def test_the_order_of_hashes_does_not_affect_the_effects() -> None:
    outputs: set[bytes] = set()
    for seed in ("0", "1", "42", "4294967295"):
        run = subprocess.run(
            [sys.executable, "-m", "laws.story"],
            cwd=TESTS, env={**os.environ, "PYTHONHASHSEED": seed}, capture_output=True, check=True,
        )  # fmt: skip
        outputs.add(run.stdout)
    assert len(outputs) == 1
    assert len(outputs.pop()) > 10_000


@pytest.mark.parametrize("seed", range(3))
def test_the_same_inputs_give_the_same_effects(seed: int) -> None:
    policy = rs.compile(everything())
    one, other = (told(Driver(policy), seed) for _ in range(2))
    assert repr(one.effects) == repr(other.effects)
    assert repr(one.trace) == repr(other.trace)


def test_the_same_simulation_gives_the_same_trace() -> None:
    traces: list[str] = []
    for _ in range(2):
        with simulate(everything()) as sim:
            tell(sim)
            sim.advance(60.0)
            traces.append(repr(list(sim.trace)))
    assert traces[0] == traces[1]


def test_the_origin_of_time_does_not_matter() -> None:
    """A later origin of time only shifts all times by the same amount."""

    def shape(driver: Driver) -> list[tuple[str, float]]:
        begin = driver.trace[0].time
        return [(type(record).__name__, record.time - begin) for record in driver.trace]

    policy = rs.compile(everything())
    early, late = Driver(policy), Driver(policy)
    late.now = 1_024.0
    assert shape(told(early)) == shape(told(late))


def test_the_engine_uses_no_clock_and_no_random_numbers(monkeypatch: pytest.MonkeyPatch) -> None:
    def forbidden(*_: object) -> Any:
        raise AssertionError("the engine is pure")

    engine = Engine(rs.compile(everything()), report_ends=True)
    log = told(Driver(everything())).log
    with monkeypatch.context() as patch:
        for owner, names in (
            (time, ["time", "monotonic", "perf_counter", "time_ns", "monotonic_ns", "sleep"]),
            (random, ["random", "choice", "shuffle", "randrange"]),
            (threading, ["Lock", "RLock", "Thread", "get_ident"]),
        ):
            for name in names:
                patch.setattr(owner, name, forbidden)
        redo(engine, log)


def state(engine: Engine) -> dict[str, Any]:
    """Return a snapshot without the next deadline. It may be too early, which is harmless."""
    return {**snapshot(engine), "next_deadline": None}


class Fidgety(Driver):
    """A driver that also advances the engine when nothing is due."""

    goal = 0.0

    def settle(self) -> None:
        super().settle()
        before = (len(self.trace), state(self.engine))
        for _ in range(3):
            self.engine.advance(self.now)
            assert self.engine.effects() == []
        assert (len(self.trace), state(self.engine)) == before

    def advance(self, seconds: float) -> None:
        self.goal = self.now + seconds
        super().advance(seconds)

    def _next(self) -> float:
        due = super()._next()
        if self.now < min(due, self.goal):
            self.engine.advance((self.now + min(due, self.goal)) / 2)  # between two deadlines, when nothing is due
            assert self.engine.effects() == []
        return due


@pytest.mark.parametrize("seed", range(3))
def test_a_spurious_advance_changes_nothing(seed: int) -> None:
    policy = rs.compile(everything())
    calm, fidgety = told(Driver(policy), seed), told(Fidgety(policy), seed)
    assert repr(calm.trace) == repr(fidgety.trace)
    assert repr(calm.effects) == repr(fidgety.effects)


@pytest.mark.parametrize("seed", range(3))
def test_a_recorded_run_can_be_replayed(seed: int) -> None:
    policy, journal = rs.compile(everything()), Journal()
    with simulate(policy, journal=journal) as sim:
        tell(sim, seed)
        sim.advance(60.0)
        live, records = sim.snapshot(), list(sim.trace)
        entries = list(journal.entries)
    again: list[Record] = []
    engine = Engine(policy)
    engine.tracer = again.append
    replay(engine, entries)
    engine.advance(live["now"])
    assert [repr(record) for record in again] == [repr(record) for record in records]
    assert state(engine) == {**live, "next_deadline": None}


def test_the_calls_up_to_a_moment_restore_the_state_of_that_moment() -> None:
    """After a crash, a new engine that gets the same calls has the same snapshot."""
    policy = rs.compile(everything())
    pictures: list[tuple[int, dict[str, Any]]] = []

    class Photographed(Driver):
        def advance(self, seconds: float) -> None:
            super().advance(seconds)
            pictures.append((len(self.log), snapshot(self.engine)))

    live = told(Photographed(policy))
    for count, picture in pictures:
        resumed = Engine(policy, report_ends=True)
        resumed.tracer = [].append
        redo(resumed, live.log[:count])
        assert snapshot(resumed) == picture


@pytest.mark.parametrize("trace", [True, False])
def test_rules_start_in_the_same_order_with_and_without_an_observer(trace: bool) -> None:
    m = rs.Module("m")
    heard, noted, out, face = m.signal("heard"), m.signal("noted"), m.slot("out", ""), m.slot("face", "")

    @m.rule(when=heard, writes=out, emits=noted, weight=3)
    async def best(ctx: rs.RuleContext) -> None:
        ctx.emit(noted)

    @m.rule(when=heard, writes=out, weight=2)
    async def second(ctx: rs.RuleContext) -> None: ...

    @m.rule(when=noted)
    async def note(ctx: rs.RuleContext) -> None: ...

    @m.rule(when=heard, writes=face)
    async def smile(ctx: rs.RuleContext) -> None: ...

    with simulate(m, trace=trace) as sim:
        sim.emit(heard)
        assert sim.fired == ["m:best", "m:smile", "m:note"]
