"""Once all rules have settled and all spikes are too old, no live object is left (law L23)."""

from __future__ import annotations

import gc

from hypothesis import given, settings

from properties.oracle import empty
from properties.strategies import worlds
from properties.worlds import Act, Play, RuleOf, SignalOf, SlotOf, Want, World
from ravestate.engine.activation import Activation
from ravestate.engine.group import NO_NUMBERS, NOTHING, Group
from ravestate.engine.spike import Spike
from ravestate.engine.watch import Watch

KINDS = (Activation, Group, Spike, Watch)


def count() -> dict[str, int]:
    """Count the live objects of the engine, by type."""
    gc.collect()
    found = {kind.__name__: 0 for kind in KINDS}
    for thing in gc.get_objects():
        if type(thing) in KINDS:
            found[type(thing).__name__] += 1
    return found


def forget(play: Play) -> None:
    """Clear the records of the play itself."""
    for kept in (play.heard, play.journal, play.taken, play.trace):
        kept.clear()  # type: ignore[attr-defined]  # all are lists


def test_each_spike_of_a_burst_of_ten_thousand_is_handled_once_and_leaves_nothing() -> None:
    world = World(
        (SignalOf(limit=20_000), SignalOf(limit=20_000)),
        (SlotOf(),),
        (
            RuleOf(((Want("s0"),),), emits=("s1",), acts=(Act(((0.0, ("emit", "s1", 1)),)),)),
            RuleOf(((Want("s1"),),), writes=("v0",)),
            RuleOf(((Want("s0"),),), writes=("v0",)),
        ),
    )
    before = count()
    play = Play(world, budget=20_000)
    for number in range(10_000):
        play.plan(number / 10_000, 0, ("emit", "s0", number))
    play.play()
    assert play.calls == {"m:r0": 10_000, "m:r1": 10_000}
    play.settle(100.0)
    forget(play)
    assert count() == before
    empty(play)
    assert play.engine.state.dropped == {}
    assert not NOTHING and not NO_NUMBERS  # the tables that all engines share stay empty


@settings(max_examples=15)
@given(worlds(ageless=False))
def test_a_random_play_leaves_nothing(world: World) -> None:
    before = count()
    play = Play(world)
    for _ in range(5):
        for seconds, op in world.inputs:
            play.tell(op)
            play.settle(seconds)
    play.settle(1000.0)
    forget(play)
    assert count() == before
