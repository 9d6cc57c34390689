"""An engine at rest keeps only its state. While it has work, it borrows its other parts from its policy."""

from __future__ import annotations

import gc
import weakref
from collections.abc import Callable
from typing import Any

import ravestate as rs
from ravestate.engine.effects import Failed, Run
from ravestate.engine.engine import SPARE, Engine
from ravestate.engine.events import AddRule, Emit, Finish, Start, Write
from ravestate.engine.explain import explain
from ravestate.engine.snapshot import snapshot

m = rs.Module("m")
go, other = m.signal("go"), m.signal("other")
count, seen = m.slot("count", 0), m.slot("seen", None)


@m.rule(when=go, writes=count, cooldown=5.0)
async def note(ctx: rs.RuleContext) -> None:
    """A rule that `serve` runs."""


@m.rule(when=go & other)
async def both(ctx: rs.RuleContext) -> None:
    """A rule that waits for a second spike."""


def serve(engine: Engine, value: int, now: float) -> None:
    """Raise ``go``, and let the rule `note` write a value."""
    engine.receive(Emit("m:go"), now)
    finish(engine, now, lambda run: engine.receive(Write("m:count", value, run), now))


def finish(engine: Engine, now: float, act: Callable[[int], None] = lambda run: None) -> None:
    """Run all rules to their ends."""
    while effects := engine.effects():
        for effect in effects:
            if isinstance(effect, Run):
                if effect.rule is note:
                    act(effect.run)
                engine.receive(Finish(effect.run, "done"), now)


def rest(engine: Engine, now: float) -> None:
    """Advance until all spikes are too old."""
    engine.advance(now)
    finish(engine, now)


def test_engines_that_take_turns_share_parts_but_no_state() -> None:
    policy = rs.compile(m)
    one, two = Engine(policy), Engine(policy)
    for turn in range(3):
        for engine, value in ((one, turn), (two, 10 + turn)):
            serve(engine, value, 10.0 * turn)
            rest(engine, 10.0 * turn + 6)
    assert len(policy.spare) == 1
    slot = policy.slot_of["m:count"].index
    assert (one.read(slot), two.read(slot)) == (2, 12)
    alone = Engine(rs.compile(m))
    for turn in range(3):
        serve(alone, 10 + turn, 10.0 * turn)
        rest(alone, 10.0 * turn + 6)
    assert snapshot(two) == snapshot(alone)
    assert two.state.ran == alone.state.ran
    assert (two.state.spikes, two.state.groups, two.state.activations) == (
        *(alone.state.spikes, alone.state.groups),
        alone.state.activations,
    )


def test_an_engine_keeps_its_parts_while_a_spike_is_live() -> None:
    policy = rs.compile(m)
    engine = Engine(policy)
    serve(engine, 1, 0.0)
    assert engine.next_deadline() == 5.0  # `both` holds the spike
    assert not policy.spare
    rest(engine, 5.0)
    assert engine.next_deadline() is None
    assert len(policy.spare) == 1


def test_an_event_that_concerns_no_rule_leaves_the_engine_at_rest() -> None:
    policy = rs.compile(m)
    engines = [Engine(policy) for _ in range(5)]
    for engine in engines:
        engine.receive(Start(), 1.0)
        engine.receive(Write("m:seen", 1), 2.0)
        assert engine.effects() == []
        assert (engine.now, engine.next_deadline(), list(engine.waiting), engine.running) == (2.0, None, [], {})
    assert len(policy.spare) == 1


def test_a_traced_engine_keeps_its_parts() -> None:
    policy = rs.compile(m)
    engine = Engine(policy)
    records: list[Any] = []
    engine.tracer = records.append
    serve(engine, 1, 0.0)
    rest(engine, 9.0)
    assert records
    assert not policy.spare
    engine.tracer = None
    assert engine.effects() == []
    assert len(policy.spare) == 1


def test_a_policy_keeps_few_spare_parts() -> None:
    policy = rs.compile(m)
    engines = [Engine(policy) for _ in range(SPARE + 10)]
    for engine in engines:
        serve(engine, 1, 0.0)
    for engine in engines:
        rest(engine, 9.0)
    assert len(policy.spare) == SPARE


def test_spare_parts_keep_nothing_of_an_engine() -> None:
    class Payload:
        """An object to which the test can hold a weak reference."""

    policy = rs.compile(m)
    engine = Engine(policy)
    value: Any = Payload()
    engine.receive(Write("m:seen", value), 0.0)
    serve(engine, 1, 1.0)
    rest(engine, 9.0)
    watched = weakref.ref(value)
    del engine, value
    gc.collect()
    assert len(policy.spare) == 1
    assert watched() is None


def test_an_engine_keeps_an_added_rule_after_a_rest() -> None:
    policy = rs.compile(m)
    engine = Engine(policy)

    async def late(ctx: rs.RuleContext) -> None:
        """A rule for one engine."""

    more = policy.with_rule(rs.Module("late").rule(when=other, writes=seen)(late))
    engine.receive(AddRule(more), 0.0)
    assert engine.policy is more
    rest(engine, 1.0)
    engine.receive(Emit("m:other"), 2.0)
    (effect,) = engine.effects()
    assert isinstance(effect, Run)
    assert effect.rule.name == "late:late"


def test_a_rule_added_to_an_engine_does_not_affect_the_next_engine_with_the_same_parts() -> None:
    first = Engine(rs.compile(m))
    for turn in range(30):
        serve(first, turn, 10.0 * turn)
        rest(first, 10.0 * turn + 6)

    async def late(ctx: rs.RuleContext) -> None:
        """A rule for one engine."""

    first.receive(AddRule(first.policy.with_rule(rs.Module("late").rule(when=other, writes=seen)(late))), 400.0)
    rest(first, 401.0)
    assert len(first.policy.spare) == 1
    second = Engine(first.policy)
    for _ in range(5):
        second.receive(Emit("m:go"), 0.0)
    second.receive(Emit("m:other"), 0.0)
    plan = second.policy.plan_of["m:both"]
    assert [len(one.holds) for one in explain(second, plan).activations].count(
        2
    ) == 1  # the five spikes have only one pair


def test_an_engine_does_not_rest_before_it_has_reported_a_predicate_that_raised() -> None:
    own = rs.Module("m")
    signal = own.signal("go")

    @own.rule(when=signal.where(lambda payload: payload > 0))
    async def positive(ctx: rs.RuleContext) -> None:
        """A rule whose predicate raises on a text."""

    engine = Engine(rs.compile(own))
    engine.receive(Emit("m:go", "three"), 0.0)
    (effect,) = engine.effects()
    assert isinstance(effect, Failed)
    assert (effect.rule, type(effect.exception)) == ("m:positive", TypeError)


def test_explain_and_snapshot_leave_an_engine_at_rest() -> None:
    policy = rs.compile(m)
    engine = Engine(policy)
    explain(engine, policy.plan_of["m:note"])
    snapshot(engine)
    assert len(policy.spare) == 1
    assert engine.next_deadline() is None


def test_a_write_to_a_built_in_flag_at_rest_is_corrected() -> None:
    policy = rs.compile(m)
    engine = Engine(policy)
    engine.receive(Write("core:activity", True), 0.0)
    finish(engine, 0.0)
    assert engine.read(policy.slot_of["core:activity"].index) is False
