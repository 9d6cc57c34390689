"""The table of an activation's states. No sequence of events corrupts an engine (laws L12, L14, L17, L18)."""

from __future__ import annotations

from typing import Any

import pytest
from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, initialize, invariant, precondition, rule

from properties.oracle import Exclusion, bounded, consistent, empty, still
from properties.strategies import worlds
from properties.worlds import Act, Play, RuleOf, SignalOf, Want, World, compiled
from ravestate.engine import events
from ravestate.engine.activation import TRANSITIONS, Activation, State, Step
from ravestate.engine.effects import Cancel, Ended, Run
from ravestate.errors import EngineError, RuleError, UndeclaredError

ONE = compiled(World((SignalOf(),), (), (RuleOf(((Want("s0"),),)),)))[1]


@pytest.mark.parametrize("step", Step)
@pytest.mark.parametrize("state", State)
def test_only_the_steps_in_the_table_are_allowed(state: State, step: Step) -> None:
    activation = Activation(7, ONE.rule_plans[0].clauses[0])
    activation.state = state
    expected = TRANSITIONS.get((state, step))
    if expected is None:
        with pytest.raises(EngineError, match=f"activation 7 of m:r0: {step.name} in state {state.name}"):
            activation.step(step)
        assert activation.state == state
    else:
        activation.step(step)
        assert activation.state == expected


def test_every_state_except_the_last_can_be_reached_and_left() -> None:
    reached = {State.GATHERING} | set(TRANSITIONS.values())
    assert reached == set(State)
    assert {state for state, _ in TRANSITIONS} == set(State) - {State.ENDED}
    assert all((state, Step.END) in TRANSITIONS for state in set(State) - {State.ENDED})


class Abuse(RuleBasedStateMachine):
    """An engine that receives random events. Some of them are allowed, and some are not."""

    def __init__(self) -> None:
        super().__init__()
        self.runs: dict[int, Run] = {}
        self.over: list[int] = []
        self.exclusion = Exclusion()
        self.ended = 0

    @initialize(world=worlds(core=False))
    def begin(self, world: World) -> None:
        self.play = Play(World(world.signals, world.slots, world.rules, (), world.patience))
        self.now = 0.0

    def receive(self, event: events.Event) -> None:
        self.play.engine.births = 0
        self.play.engine.receive(event, self.now)

    def refused(self, event: events.Event, *errors: type[Exception]) -> None:
        """Assert that the engine refuses an event with a clear error, and that the event changes nothing."""
        before = still(self.play)
        with pytest.raises(errors) as caught:
            self.receive(event)
        assert str(caught.value)
        assert still(self.play) == before

    @rule()
    def pump(self) -> None:
        self.take()

    def take(self) -> bool:
        self.play.engine.births = 0
        effects = self.play.engine.effects()
        for effect in effects:
            self.exclusion(self.play, effect)
        for effect in effects:
            if isinstance(effect, Run):
                assert effect.run not in self.runs
                self.runs[effect.run] = effect
            elif isinstance(effect, Cancel):
                assert effect.run in self.runs or effect.run in self.over
            elif isinstance(effect, Ended):
                assert effect.run in self.over
        return bool(effects)

    @rule(seconds=st.sampled_from([0.0, 0.25, 0.5, 1.0, 5.0, 100.0]))
    def wait(self, seconds: float) -> None:
        self.now = self.play.now = self.now + seconds
        self.play.engine.births = 0
        self.play.engine.advance(self.now)

    @rule(data=st.data(), inside=st.booleans())
    def write(self, data: st.DataObject, inside: bool) -> None:
        run = data.draw(st.sampled_from([*self.runs.values()])) if inside and self.runs else None
        slots = list(self.play.engine.policy.slots.values())
        slot = data.draw(st.sampled_from([slot for slot in slots if not slot.name.startswith("core:")]))
        value: Any = data.draw(st.sampled_from([0, 1, 2]))
        event: events.Event
        if slot.kind == "flag":
            event = events.Write(slot.name, bool(value), run and run.run)
        elif slot.kind == "collection":
            event = events.Store(slot.name, "a", value, run and run.run)
        else:
            event = events.Write(slot.name, value, run and run.run)
        if run is not None and slot not in run.rule.writes:
            self.refused(event, UndeclaredError)
        else:
            self.receive(event)

    @rule(data=st.data(), inside=st.booleans())
    def emit(self, data: st.DataObject, inside: bool) -> None:
        run = data.draw(st.sampled_from([*self.runs.values()])) if inside and self.runs else None
        names = [s.name for s in run.rule.emits] if run else [f"m:s{n}" for n in range(len(self.play.world.signals))]
        if names:
            name = data.draw(st.sampled_from(names))
            self.receive(events.Emit(name, data.draw(st.sampled_from([0, 1, 2])), run and run.run))

    @rule(data=st.data())
    def wipe(self, data: st.DataObject) -> None:
        self.receive(events.Wipe(data.draw(st.sampled_from(list(self.play.engine.policy.signals)))))

    @precondition(lambda self: self.runs)
    @rule(data=st.data(), kind=st.sampled_from(["done", "done", "resigned", "failed", "retired"]))
    def finish(self, data: st.DataObject, kind: events.OutcomeKind) -> None:
        run = data.draw(st.sampled_from(list(self.runs)))
        del self.runs[run]
        self.over.append(run)
        self.receive(events.Finish(run, kind, "", ValueError("on purpose") if kind == "failed" else None))

    @precondition(lambda self: self.over)
    @rule(data=st.data(), what=st.sampled_from(["finish", "write", "emit", "store", "discard", "wipe"]))
    def act_after_the_end(self, data: st.DataObject, what: str) -> None:
        run = data.draw(st.sampled_from([*self.over, 10**9]))
        self.refused(
            {
                "finish": events.Finish(run, "done"),
                "write": events.Write("m:v0", 1, run),
                "store": events.Store("m:v0", "a", 1, run),
                "discard": events.Discard("m:v0", "a", run),
                "emit": events.Emit("m:s0", 1, run),
                "wipe": events.Wipe("m:s0", run),
            }[what],
            EngineError,
            RuleError,
        )

    @rule(what=st.sampled_from(["write", "store", "discard", "emit", "wipe"]))
    def name_an_unknown(self, what: str) -> None:
        self.refused(
            {
                "write": events.Write("m:v00", 1),
                "store": events.Store("m:v00", "a", 1),
                "discard": events.Discard("m:v00", "a"),
                "emit": events.Emit("m:s00", 1),
                "wipe": events.Wipe("m:s00"),
            }[what],
            UndeclaredError,
        )

    @invariant()
    def is_whole(self) -> None:
        if hasattr(self, "play"):
            consistent(self.play.engine)

    def teardown(self) -> None:
        if not hasattr(self, "play"):
            return
        while self.take() or self.runs:
            for run in list(self.runs):
                del self.runs[run]
                self.over.append(run)
                self.receive(events.Finish(run, "retired"))
        self.play.specs = {name: RuleOf((), acts=(Act(),)) for name in self.play.specs}
        self.play.settle(0.0)
        bounded(self.play)
        for _ in range(3):
            self.play.wipe_all()
            self.play.settle(1000.0)
        empty(self.play)


Abuse.TestCase.settings = settings(max_examples=max(20, settings.default.max_examples // 5), stateful_step_count=30)
TestAbuse = Abuse.TestCase
