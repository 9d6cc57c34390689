"""A *first spike* waits for the second spike of a rule `a & b`. A *half* keeps first spikes without activations.

Halves save time and memory, and do not change the runs.
"""

from __future__ import annotations

import random
from typing import Any

import pytest

import ravestate as rs
from ravestate.engine.effects import Run
from ravestate.engine.engine import Engine
from ravestate.engine.events import AddRule, Emit, Event, Finish, Wipe
from ravestate.engine.explain import explain


def declared(module: rs.Module, name: str, **options: Any) -> None:
    """Declare a rule. Its function does nothing, because a bare engine does not call it."""

    async def function(ctx: Any) -> None:
        """Do nothing."""

    module.rule(name=name, **options)(function)


def runs(engine: Engine, *given: Event, now: float = 0.0, end: bool = True) -> list[Run]:
    """Let an engine receive events at one time. Return the runs, which end immediately unless `end` is false."""
    for event in given:
        engine.receive(event, now)
    found: list[Run] = []
    while effects := engine.effects():
        for effect in effects:
            if isinstance(effect, Run):
                found.append(effect)
                if end:
                    engine.receive(Finish(effect.run, "done"), now)
    return found


def void(_: object) -> None:
    """Ignore a record."""


def payloads(found: list[Run]) -> list[tuple[Any, ...]]:
    """Return the payloads of each run."""
    return [tuple(run.payloads.values()) for run in found]


def pair(**options: Any) -> Engine:
    """Return an engine with one rule `a & b`."""
    m = rs.Module("m")
    a, b = m.signal("a"), m.signal("b")
    declared(m, "both", when=a & b, **options)
    return Engine(rs.compile(m))


def activations(engine: Engine) -> int:
    """Return the number of activations."""
    return sum(len(each) for each in engine.state.active.values())


def test_a_first_spike_makes_no_activation_and_counts_as_activity() -> None:
    engine = pair()
    assert not runs(engine, Emit("m:a", 1))
    assert activations(engine) == 0
    assert engine.read(engine.policy.slot_of["core:activity"].index) is True
    runs(engine, now=5.0)
    engine.advance(5.0)
    runs(engine, now=5.0)
    assert engine.read(engine.policy.slot_of["core:activity"].index) is False
    assert not engine.state.live
    assert not engine.state.halves


@pytest.mark.parametrize("together", [True, False])
def test_the_oldest_spikes_become_a_pair(together: bool) -> None:
    engine = pair()
    firsts: list[Event] = [Emit("m:a", n) for n in range(3)]
    seconds: list[Event] = [Emit("m:b", n) for n in range(3)]
    found = (
        runs(engine, *firsts, *seconds) if together else [run for e in (*firsts, *seconds) for run in runs(engine, e)]
    )
    assert payloads(found) == [(0, 0), (1, 1), (2, 2)]
    assert activations(engine) == 0


def test_a_pair_makes_only_one_activation_even_if_many_spikes_wait() -> None:
    engine = pair()
    runs(engine, *(Emit("m:a", n) for n in range(20)))
    engine.receive(Emit("m:b", 0), 0.0)
    assert activations(engine) == 1


def test_the_next_spike_takes_the_place_of_a_wiped_one() -> None:
    m = rs.Module("m")
    a, b, root = m.signal("a"), m.signal("b"), m.signal("root")
    declared(m, "raises", when=root, emits=a)
    declared(m, "both", when=a & b)
    engine = Engine(rs.compile(m))
    [first] = runs(engine, Emit("m:root"), end=False)
    runs(engine, Emit("m:a", "wiped", first.run), Finish(first.run, "done"))
    runs(engine, Emit("m:a", "stays"))
    found = runs(engine, Emit("m:b", 1), Wipe("m:root"))
    assert payloads(found) == [("stays", 1)]


def test_only_the_rule_whose_topic_occurs_gets_an_activation() -> None:
    m = rs.Module("m")
    utterance, out = m.signal("utterance"), m.slot("out", "")
    topics = [m.signal(f"topic{n}") for n in range(50)]
    declared(m, "classifier", when=utterance, emits=topics)
    for n, topic in enumerate(topics):
        declared(m, f"about{n}", when=utterance & topic, writes=out)
    engine = Engine(rs.compile(m))
    [classifier] = runs(engine, Emit("m:utterance"), end=False)
    assert activations(engine) == 1
    engine.receive(Emit("m:topic7", None, classifier.run), 0.0)
    assert activations(engine) == 2
    # The classifier may still raise the topic of a rule that was declared earlier, so the rule about7 waits.
    assert not runs(engine, end=False)
    [run] = runs(engine, Finish(classifier.run, "done"))
    assert run.rule.name == "m:about7"
    assert activations(engine) == 0
    assert not engine.state.halves


def test_a_rule_waits_with_patience_for_a_rival_that_has_no_activation() -> None:
    m = rs.Module("m")
    speech, point, out = m.signal("speech"), m.signal("point"), m.slot("out", "")
    declared(m, "fused", when=speech & point, writes=out)
    declared(m, "plain", when=speech, writes=out)
    engine = Engine(rs.compile(m))
    assert not runs(engine, Emit("m:speech"))
    engine.advance(1.0)
    [run] = runs(engine, now=1.0)
    assert run.rule.name == "m:plain"
    assert not runs(engine, Emit("m:point"), now=1.0)


def test_a_rule_that_resigned_leaves_the_spikes_to_other_rules() -> None:
    m = rs.Module("m")
    a, b, out = m.signal("a"), m.signal("b"), m.slot("out", "")
    declared(m, "first", when=a & b, writes=out, weight=2.0)
    declared(m, "second", when=a & b, writes=out)
    engine = Engine(rs.compile(m))
    [run] = runs(engine, Emit("m:a"), Emit("m:b"), end=False)
    [other] = runs(engine, Finish(run.run, "resigned", "no"))
    assert (run.rule.name, other.rule.name) == ("m:first", "m:second")


def with_added_pair(held: str, traced: bool) -> Engine:
    """Return an engine to which a rule `a & b` was added while a spike of the signal `held` was live."""
    m = rs.Module("m")
    signals = {name: m.signal(name) for name in "ab"}
    declared(m, "keeps", when=signals[held] & m.signal("c"))
    engine = Engine(rs.compile(m))
    engine.tracer = void if traced else None
    assert not runs(engine, Emit(f"m:{held}", "old"))

    @m.rule(when=signals["a"] & signals["b"])
    async def both(ctx: Any) -> None:
        """Do nothing."""

    engine.receive(AddRule(engine.policy.with_rule(both)), 0.0)
    return engine


@pytest.mark.parametrize("traced", [False, True])
@pytest.mark.parametrize("firsts", [2, 3])
def test_an_added_rule_that_loses_a_spike_takes_one_that_is_older_than_the_rule(firsts: int, traced: bool) -> None:
    engine = with_added_pair("b", traced)
    assert not runs(engine, *[Emit("m:a", n) for n in range(firsts)])
    assert payloads(runs(engine, Emit("m:b", "new"))) == [(0, "new"), (1, "old")]
    assert payloads(runs(engine, Emit("m:b", "newer"))) == [(n, "newer") for n in range(2, firsts)]
    assert not runs(engine, now=10.0)


@pytest.mark.parametrize("traced", [False, True])
def test_the_spike_that_is_older_than_an_added_rule_can_be_of_either_signal(traced: bool) -> None:
    engine = with_added_pair("a", traced)
    found = runs(engine, Emit("m:a", 1), Emit("m:b", 2), Emit("m:b", 3), Emit("m:a", 4))
    assert payloads(found) == [(1, 2), (4, 3)]
    assert payloads(runs(engine, Emit("m:b", 5))) == [("old", 5)]


def test_a_rule_still_pairs_spikes_after_another_rule_has_retired() -> None:
    m = rs.Module("m")
    a, b = m.signal("a"), m.signal("b")
    declared(m, "both", when=a & b)
    declared(m, "other", when=a & m.signal("c"))
    engine = Engine(rs.compile(m))
    [run] = runs(engine, Emit("m:a"), Emit("m:c"), end=False)
    engine.receive(Finish(run.run, "retired"), 0.0)
    assert not runs(engine, Wipe("m:a"))
    assert payloads(runs(engine, Emit("m:b", 1), Emit("m:a", 2))) == [(2, 1)]
    assert payloads(runs(engine, Emit("m:a", 3), Emit("m:b", 4))) == [(3, 4)]
    assert not runs(engine, Emit("m:a"), Emit("m:c"))


@pytest.mark.parametrize("traced", [False, True])
def test_after_a_false_predicate_no_further_predicate_is_called(traced: bool) -> None:
    m = rs.Module("m")
    a, b = m.signal("a"), m.signal("b")
    declared(m, "both", when=a.where(lambda n: n is not None).where(lambda n: n > 0) & b)
    engine = Engine(rs.compile(m))
    engine.tracer = void if traced else None
    engine.receive(Emit("m:a", None), 0.0)
    assert not engine.effects()
    assert payloads(runs(engine, Emit("m:a", 1), Emit("m:b", 2))) == [(1, 2)]


def test_an_explanation_shows_a_first_spike() -> None:
    engine = pair()
    runs(engine, Emit("m:a", 1))
    [state] = explain(engine, engine.policy.rule_plan("m:both")).activations
    assert (state.state, state.holds, state.lacks) == ("gathering", (("m:a", 0.0),), ("m:b",))
    assert payloads(runs(engine, Emit("m:b", 2))) == [(1, 2)]


def test_activations_that_need_no_consent_start_in_batches() -> None:
    m = rs.Module("m")
    declared(m, "each", when=m.signal("a", limit=1000))
    engine = Engine(rs.compile(m))
    for n in range(250):
        engine.receive(Emit("m:a", n), 0.0)
    sizes = list[int]()
    while effects := engine.effects():
        sizes.append(len(effects))
        for effect in effects:
            if isinstance(effect, Run):
                engine.receive(Finish(effect.run, "done"), 0.0)
    assert sizes == [100, 100, 50]


@pytest.mark.parametrize("seed", range(5))
def test_rules_that_share_first_spikes_each_take_them_in_order(seed: int) -> None:
    m = rs.Module("m")
    a, b, c = (m.signal(name, limit=9999) for name in "abc")
    declared(m, "one", when=a & b)
    declared(m, "other", when=a & c)
    engine, chance = Engine(rs.compile(m)), random.Random(seed)
    given = dict.fromkeys("abc", 0)
    found: dict[str, list[tuple[Any, ...]]] = {"m:one": [], "m:other": []}
    for turn in range(400):
        name = chance.choices("abc", (10, 5, 4) if turn < 200 else (1, 10, 10))[0]
        for run in runs(engine, Emit(f"m:{name}", given[name])):
            found[run.rule.name].append(tuple(run.payloads.values()))
        given[name] += 1
    assert len(found["m:one"]) == min(given["a"], given["b"])
    assert len(found["m:other"]) == min(given["a"], given["c"])
    assert all(pair == (n, n) for each in found.values() for n, pair in enumerate(each))
    engine.advance(10.0)
    assert not runs(engine, now=10.0)
    assert not (engine.state.live or engine.state.halves or engine.state.rows)
