"""On a *bench*, the spikes of one signal wait together for a spike of the other signal of a rule `a & b`.

That other spike is called the *counterpart*. Only a rule without better rivals has benches. The rule runs on the same
spikes as it would without benches.
"""

from __future__ import annotations

from typing import Any

import pytest

import ravestate as rs
from engine.test_halves import activations, declared, pair, payloads, runs
from properties.worlds import Act, Play, RuleOf, SignalOf, SlotOf, Want, World
from ravestate.engine.engine import Engine
from ravestate.engine.events import Emit, Event, Finish, Wipe
from ravestate.engine.explain import explain


def writer() -> Engine:
    """Return an engine with one rule `a & b`, the only writer of its slot."""
    m = rs.Module("m")
    declared(m, "both", when=m.signal("a") & m.signal("b"), writes=m.slot("out", ""))
    return Engine(rs.compile(m))


def at_rest(engine: Engine) -> bool:
    """Return whether no table holds a spike or an activation."""
    state = engine.state
    tables: list[Any] = [state.active, state.live, state.halves, state.seats, state.pools, state.benches]
    return not any(tables)


def burst(signal: str, count: int, first: int = 0) -> list[Event]:
    """Return `count` events that emit a signal, with the numbers from `first` on as payloads."""
    return [Emit(signal, n) for n in range(first, first + count)]


@pytest.mark.parametrize("together", [True, False])
def test_the_oldest_spikes_become_a_pair(together: bool) -> None:
    engine = writer()
    given = [*burst("m:a", 5), *burst("m:b", 5)]
    found = runs(engine, *given) if together else [run for event in given for run in runs(engine, event)]
    assert payloads(found) == [(n, n) for n in range(5)]
    assert at_rest(engine)


def test_many_spikes_that_share_a_counterpart_make_only_one_activation() -> None:
    engine = writer()
    runs(engine, *burst("m:a", 20), Emit("m:b", 0), end=False)
    assert activations(engine) == 1
    assert engine.read(engine.policy.slot_of["core:pressure"].index) is True


def test_the_bench_takes_no_new_counterpart_while_it_has_one() -> None:
    engine = writer()
    [run] = runs(engine, *burst("m:a", 3), Emit("m:b", 0), end=False)
    assert not runs(engine, Emit("m:b", 1), end=False)
    [following] = runs(engine, Finish(run.run, "done"), end=False)
    assert payloads([following]) == [(1, 1)]


def test_after_a_resignation_the_bench_takes_the_next_counterpart() -> None:
    engine = writer()
    [run] = runs(engine, *burst("m:a", 3), *burst("m:b", 2), end=False)
    [following] = runs(engine, Finish(run.run, "resigned", "no"), end=False)
    assert payloads([following]) == [(1, 1)]


def test_a_spike_with_a_counterpart_does_not_grow_too_old() -> None:
    engine = writer()
    [run] = runs(engine, *burst("m:a", 2), Emit("m:b", 0), end=False)
    runs(engine, Emit("m:b", 1), now=4.0)
    runs(engine, now=8.0)
    [following] = runs(engine, Finish(run.run, "done"), now=8.0)
    assert payloads([following]) == [(1, 1)]
    assert at_rest(engine)


def test_a_spike_that_has_grown_too_old_beside_its_counterpart_takes_no_other() -> None:
    engine = writer()
    [run] = runs(engine, *burst("m:a", 3), Emit("m:b", 0), end=False)
    runs(engine, now=8.0)
    assert engine.state.benches
    assert not runs(engine, Finish(run.run, "done"), now=8.0)
    assert at_rest(engine)
    assert not runs(engine, Emit("m:b", 1), now=8.0)


def test_the_next_counterpart_takes_the_place_of_a_withdrawn_one() -> None:
    m = rs.Module("m")
    a, b = m.signal("a"), m.signal("b", limit=1)
    declared(m, "both", when=a & b, writes=m.slot("out", ""))
    engine = Engine(rs.compile(m))
    assert payloads(runs(engine, *burst("m:a", 3), *burst("m:b", 2))) == [(0, 1)]
    assert not runs(engine, Wipe("m:a"))
    assert at_rest(engine)


def test_the_next_spike_asks_in_the_same_round_if_the_group_of_the_first_spike_refuses() -> None:
    # The first s0 pairs with the first s1. The group of this s0 can answer only once, so it refuses a pair with the third
    # s1. The second s0 takes the third s1 in the same round of consent.
    both = RuleOf(when=((Want("s0"), Want("s1")),), writes=("v0",), acts=(Act(seconds=1.0),))
    other = RuleOf(when=((Want("s2"),),), writes=("v1",))
    inputs = tuple((0.0, ("emit", signal, n)) for n, signal in enumerate(("s1", "s1", "s0", "s0", "s1", "s2")))
    world = World((SignalOf(),) * 3, (SlotOf(), SlotOf()), (both, other), inputs, together=True)
    play = Play(world, budget=6).play()
    starts = [line for line in play.heard if "< Run(" in line]
    assert [line.split(" s <")[0] for line in starts][:3] == ["0"] * 3


def test_an_explanation_shows_the_spikes_on_a_bench() -> None:
    engine = writer()
    runs(engine, *burst("m:a", 2), Emit("m:b", 0), end=False)
    states = explain(engine, engine.policy.rule_plan("m:both")).activations
    assert [(one.state, one.holds) for one in states] == [
        ("running", (("m:a", 0.0), ("m:b", 0.0))),
        ("waiting", (("m:a", 0.0), ("m:b", 0.0))),
        ("gathering", (("m:b", 0.0),)),
    ]


def test_a_tracer_does_not_change_the_runs() -> None:
    quiet, traced = writer(), writer()
    [run] = runs(traced, *burst("m:a", 4), Emit("m:b", 0), end=False)
    [same] = runs(quiet, *burst("m:a", 4), Emit("m:b", 0), end=False)
    traced.tracer = lambda record: None
    rest = [*burst("m:b", 2, 1), *burst("m:a", 1, 4)]
    found = [payloads(runs(one, *rest, Finish(first.run, "done"))) for one, first in ((quiet, same), (traced, run))]
    assert found[0] == found[1] == [(1, 1), (2, 2)]


def test_a_rule_without_slots_needs_no_bench() -> None:
    engine = pair()
    runs(engine, *burst("m:a", 3))
    assert not engine.state.seats


def test_a_fallback_asks_again_when_a_bench_loses_its_last_counterpart() -> None:
    m = rs.Module("m")
    a, b, out = m.signal("a"), m.signal("b"), m.slot("out", "")
    declared(m, "both", when=a & b, writes=out)
    declared(m, "fallback", when=a, writes=out)
    engine = Engine(rs.compile(m))
    assert not runs(engine, *burst("m:a", 2))
    [run] = runs(engine, Emit("m:b", 0), now=0.5, end=False)
    engine.advance(1.0)
    assert not runs(engine, now=1.0, end=False)
    [other] = runs(engine, Finish(run.run, "done"), now=2.0, end=False)
    assert other.rule.name == "m:fallback"  # the patience of `both` ended at 1 s, while `both` was still ready
    assert payloads([other]) == [(1,)]
