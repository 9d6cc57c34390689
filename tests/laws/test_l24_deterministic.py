"""L24: a pure state machine: the same inputs and times give the same effects, byte for byte, in any process."""

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
from ravestate.runtime.journal import Entry, Journal, replay
from ravestate.testing import Simulation, simulate
from scenarios.driver import Driver

TESTS = Path(__file__).parents[1]


def told(driver: Driver, seed: int = 7) -> Driver:
    with driver:
        tell(driver, seed)
        driver.advance(60.0)
    return driver


def test_the_same_effects_under_any_order_of_hashes() -> None:
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
    """Times are the caller's: a thousand seconds later everything happens a thousand seconds later."""

    def shape(driver: Driver) -> list[tuple[str, float]]:
        begin = driver.trace[0].time
        return [(type(record).__name__, round(record.time - begin, 6)) for record in driver.trace]

    policy = rs.compile(everything())
    early, late = Driver(policy), Driver(policy)
    late.now = 1_000.0
    assert shape(told(early)) == shape(told(late))


def test_the_engine_asks_no_clock_and_throws_no_dice(monkeypatch: pytest.MonkeyPatch) -> None:
    def forbidden(*_: object) -> Any:
        raise AssertionError("the engine is pure")

    driver = Driver(everything())
    events = told(Driver(everything())).events
    with monkeypatch.context() as patch:
        for owner, names in (
            (time, ["time", "monotonic", "perf_counter", "time_ns", "monotonic_ns", "sleep"]),
            (random, ["random", "choice", "shuffle", "randrange"]),
            (threading, ["Lock", "RLock", "Thread", "get_ident"]),
        ):
            for name in names:
                patch.setattr(owner, name, forbidden)
        for event, moment in events[:10]:
            if getattr(event, "run", None) is None:
                driver.now = moment
                driver.tell(event)


class Fidgety(Driver):
    """Advances the engine again and again, for nothing."""

    def settle(self) -> None:
        super().settle()
        deadline = self.engine.next_deadline()
        before = (len(self.trace), repr(snapshot(self.engine)))
        for _ in range(3):
            self.engine.advance(self.now)
            assert self.engine.effects() == []
            assert self.engine.next_deadline() == deadline
        assert (len(self.trace), repr(snapshot(self.engine))) == before

    def _next(self) -> float:
        due = super()._next()
        if due < float("inf"):  # somewhere on the way, where nothing is due
            self.engine.advance(self.now + (due - self.now) / 2)
            assert self.engine.effects() == []
        return due


@pytest.mark.parametrize("seed", range(3))
def test_a_spurious_advance_changes_nothing(seed: int) -> None:
    policy = rs.compile(everything())
    calm, fidgety = told(Driver(policy), seed), told(Fidgety(policy), seed)
    assert repr(calm.trace) == repr(fidgety.trace)
    assert repr(calm.effects) == repr(fidgety.effects)


@pytest.mark.parametrize("seed", range(3))
def test_what_was_recorded_can_be_replayed(seed: int) -> None:
    policy, journal = rs.compile(everything()), Journal()
    context = rs.Context(policy, seed=0, trace=True, journal=journal)
    with Simulation(context) as sim:
        tell(sim, seed)
        sim.advance(60.0)
        live, records = sim.snapshot(), list(sim.trace)
        entries = list(journal.entries)
    again: list[Record] = []
    engine = Engine(policy)
    engine.tracer = again.append
    replay(engine, entries)
    engine.advance(live["now"])
    assert repr(again) == repr(records)
    assert snapshot(engine) == live


def test_after_a_crash_it_resumes_where_it_was() -> None:
    """What an engine was told up to a moment is all that its state depends on."""
    policy = rs.compile(everything())
    pictures: list[tuple[int, dict[str, Any]]] = []

    class Photographed(Driver):
        def advance(self, seconds: float) -> None:
            super().advance(seconds)
            pictures.append((len(self.events), snapshot(self.engine)))

    live = told(Photographed(policy))
    for count, picture in pictures:
        resumed = Engine(policy)
        resumed.tracer = [].append
        replay(resumed, [Entry(moment, event) for event, moment in live.events[:count]])
        resumed.advance(picture["now"])
        assert snapshot(resumed) == picture
