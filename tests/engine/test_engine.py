"""The engine refuses impossible events with a clear message."""

from __future__ import annotations

from typing import Any, cast

import pytest

import ravestate as rs
from ravestate.engine import events
from ravestate.engine.effects import Run
from ravestate.engine.engine import Engine
from ravestate.errors import EngineError

m = rs.Module("m")
go, lit = m.signal("go"), m.flag("lit")


@m.rule(when=go, writes=lit)
async def light(ctx: rs.RuleContext) -> None:
    """A rule that the engine starts. No test calls its function."""


def running() -> tuple[Engine, int]:
    """Return an engine, and the number of the run that it has started."""
    engine = Engine(rs.compile(m))
    engine.receive(events.Emit("m:go"), 0.0)
    (effect,) = engine.effects()
    assert isinstance(effect, Run)
    return engine, effect.run


@pytest.mark.parametrize(
    ("event", "message"),
    [
        (events.Store("m:lit", "key", 1), "m:lit is not a collection"),
        (events.Discard("m:lit", "key"), "m:lit is not a collection"),
        (events.AddRule(rs.compile(rs.Module("other"))), r"make it with policy\.with_rule\(rule\)"),
        (events.Finish(999, "done"), "run 999 is over, or never began"),
        (cast("Any", "go"), "'go' is not an event"),
    ],
)
def test_an_impossible_event_is_refused_and_changes_nothing(event: Any, message: str) -> None:
    engine, run = running()
    with pytest.raises(EngineError, match=message):
        engine.receive(event, 1.0)
    engine.receive(events.Write("m:lit", True, run), 1.0)
    engine.receive(events.Finish(run, "done"), 1.0)
    assert engine.effects() == []
    assert engine.read(engine.policy.slot_of["m:lit"].index) is True


def test_a_run_ends_in_one_of_four_ways() -> None:
    engine, run = running()
    with pytest.raises(EngineError, match="done, resigned, failed, retired, not by 'won'"):
        engine.receive(events.Finish(run, cast("Any", "won")), 1.0)
    engine.receive(events.Finish(run, "done"), 1.0)  # the refused event has not ended the run


@pytest.mark.parametrize("at_rest", [True, False])
@pytest.mark.parametrize("time", [float("nan"), float("inf")])
def test_the_engine_receives_events_only_at_a_finite_time(time: float, at_rest: bool) -> None:
    engine = Engine(rs.compile()) if at_rest else running()[0]
    now = engine.now
    with pytest.raises(ValueError, match=f"the time is {time}: write a finite number of seconds"):
        engine.receive(events.Stop(), time)
    assert engine.now == now
    engine.receive(events.Stop(), -float("inf"))  # has passed already
    assert engine.now == now


@pytest.mark.parametrize("at_rest", [True, False])
@pytest.mark.parametrize("time", [float("nan"), float("inf")])
def test_the_engine_advances_only_to_a_finite_time(time: float, at_rest: bool) -> None:
    engine = Engine(rs.compile()) if at_rest else running()[0]
    now = engine.now
    with pytest.raises(ValueError, match=rf"advance\({time}\): write a finite number of seconds"):
        engine.advance(time)
    assert engine.now == now
    engine.advance(-float("inf"))  # has passed already
    engine.advance(now + 1.0)
    assert engine.now == now + 1.0
