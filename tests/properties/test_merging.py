"""Random worlds with merging groups: no rule misses a spike, in whatever order the groups merge (laws L11, L12)."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from properties.oracle import Exclusion, bounded
from properties.worlds import Act, Op, Play, RuleOf, SignalOf, SlotOf, Want, World

GAPS = st.sampled_from([0.0, 0.0, 0.5])


@st.composite
def merging_worlds(draw: st.DrawFn) -> World:
    """Generate worlds in which each signal occurs once. Each rule raises its own signal."""
    inputs = [f"s{n}" for n in range(draw(st.integers(2, 4)))]
    known, signals, slots = list(inputs), [SignalOf() for _ in inputs], list[SlotOf]()
    rules: list[RuleOf] = []
    for _ in range(draw(st.integers(2, 6))):
        needs = draw(st.lists(st.sampled_from(known), unique=True, min_size=1, max_size=3))
        when = (tuple(Want(name, max_age=None) for name in needs),)
        if draw(st.booleans()):
            name = f"v{len(slots)}"
            op: Op = ("write", name, 1)
            known.append(f"{name}:changed")
            slots.append(SlotOf())
            rule = RuleOf(when, writes=(name,), acts=(Act(((draw(GAPS), op),)),))
        else:
            name = f"s{len(signals)}"
            known.append(name)
            signals.append(SignalOf())
            rule = RuleOf(when, emits=(name,), acts=(Act(((draw(GAPS), ("emit", name, 1)),)),))
        rules.append(rule)
    order = draw(st.permutations(inputs))
    events = tuple((draw(GAPS), ("emit", name, 1)) for name in order)
    return World(tuple(signals), tuple(slots), tuple(rules), events)


@given(merging_worlds())
def test_every_rule_runs_once_in_whatever_order_its_groups_merge(world: World) -> None:
    play = Play(world, before=bounded, started=Exclusion()).play()
    assert play.calls == {f"m:r{number}": 1 for number in range(len(world.rules))}
