"""L23: every signal has an overflow policy, and an engine at rest holds nothing.

An endless loop does not keep other rules from running.
"""

import asyncio
import gc
from collections import Counter
from collections.abc import Callable
from typing import Any

import pytest

import ravestate as rs
from laws.short import at_rest, drops, emitter, hearer, output, writer, written
from laws.story import everything, tell
from scenarios.driver import Driver


def test_when_a_signal_exceeds_its_limit_its_oldest_spike_is_dropped_counted_and_traced(play: Any) -> None:
    m = rs.Module("m")
    a, b, heard = m.signal("a", payload=int, limit=3), m.signal("b"), list[Any]()
    hearer(m, "pair", a & b, a, heard)
    with play(m) as sim:
        for number in range(5):
            sim.emit(a, number)
        assert len(sim.snapshot()["spikes"]) == 3
        assert sim.snapshot()["dropped"] == {"m:a": 2}
        assert len(drops(sim, a)) == 2
        for _ in range(5):
            sim.emit(b)
        assert heard == [2, 3, 4]


def test_all_spikes_are_kept_up_to_the_limit(play: Any) -> None:
    m = rs.Module("m")
    a, b, heard = m.signal("a", payload=int, limit=3), m.signal("b"), list[Any]()
    hearer(m, "pair", a & b, a, heard)
    with play(m) as sim:
        for number in range(3):
            sim.emit(a, number)
        assert sim.snapshot()["dropped"] == {}
        for _ in range(3):
            sim.emit(b)
        assert heard == [0, 1, 2]


def test_the_limit_counts_live_spikes_only(play: Any) -> None:
    m = rs.Module("m")
    a, heard = m.signal("a", payload=int, limit=1), list[Any]()
    hearer(m, "hear", a, a, heard)
    with play(m) as sim:
        for number in range(10):
            sim.emit(a, number)
        assert heard == list(range(10))
        assert sim.snapshot()["dropped"] == {}


def test_keep_latest_keeps_only_the_newest_spike(play: Any) -> None:
    m = rs.Module("m")
    a, b, heard = m.signal("a", payload=int, keep="latest"), m.signal("b"), list[Any]()
    hearer(m, "pair", a & b, a, heard)
    with play(m) as sim:
        for number in range(5):
            sim.emit(a, number)
        assert [spike["payload"] for spike in sim.snapshot()["spikes"] if spike["signal"] == "m:a"] == [4]
        assert len(drops(sim, a)) == 4


def test_a_conjunction_that_never_gets_its_last_signal_has_few_activations_for_each_live_spike(play: Any) -> None:
    # L12: an activation that lost a spike takes another. So ever more activations would go on with the same spikes.
    m = rs.Module("m")
    picture, sound, word, out = m.signal("picture"), m.signal("sound"), m.signal("word"), output(m)
    writer(m, "fuse", picture & sound & word, out)
    with play(m) as sim:
        for _ in range(200):
            sim.emit(picture)
            sim.emit(sound)
            sim.advance(0.1)
        left = sim.snapshot()
        assert len(left["activations"]) <= 2 * len(left["spikes"])
        sim.emit(word)
        assert written(sim, out) == ["fuse"]


def test_every_signal_has_a_limit() -> None:
    m = rs.Module("m")
    m.slot("text", "")
    m.collection("people", limit=7)
    assert [signal.limit for signal in m.slots[1].signals] == [7, 7, 7]
    assert all(signal.limit >= 1 for signal in (*m.slots[0].signals, rs.startup, *rs.activity.signals))
    with pytest.raises(rs.DeclarationError, match="limit=0"):
        m.signal("none", limit=0)
    with pytest.raises(rs.DeclarationError, match="'first'"):
        m.signal("none", keep="first")  # type: ignore[arg-type]


def census() -> Counter[str]:
    """Count the live objects of the engine, by kind."""
    gc.collect()
    kinds = (type(one) for one in gc.get_objects())
    return Counter(k.__qualname__ for k in kinds if str(k.__module__).startswith("ravestate.engine"))


def test_nothing_is_left_once_all_rules_have_settled_and_all_spikes_are_too_old(play: Any) -> None:
    with play(everything()) as sim:
        tell(sim)
        assert not at_rest(sim)
        sim.advance(60.0)
        assert at_rest(sim)
        assert sim.read(rs.activity) is False
        assert sim.read(rs.pressure) is False


def test_the_number_of_live_objects_at_rest_does_not_grow() -> None:
    with Driver(everything(), trace=False) as sim:
        counts: list[Counter[str]] = []
        for _ in range(3):
            tell(sim)
            sim.advance(60.0)
            sim.failures.clear()
            sim.log.clear()
            sim.effects.clear()
            counts.append(census())
        assert counts[0] == counts[1] == counts[2]
        assert not {"Spike", "Activation", "Group", "Watch"} & set(counts[0])


def test_a_wiped_signal_leaves_nothing_behind(play: Any) -> None:
    m = rs.Module("m")
    a, b, out = m.signal("a"), m.signal("b"), output(m)
    writer(m, "both", a.max_age(None) & b, out)
    with play(m) as sim:
        for _ in range(50):
            sim.emit(a)
        sim.advance(1_000.0)
        assert len(sim.snapshot()["spikes"]) == 50  # with max_age=None, spikes never grow too old
        sim.wipe(a)
        assert at_rest(sim)
        assert written(sim, out) == []


def endless(m: rs.Module, *stages: rs.Signal[Any], until: Callable[[], bool]) -> Counter[str]:
    """Declare detached rules that trigger each other in a loop; return the count of each rule's runs.

    The loop ends when `until()` is true, or when a rule has run 5,000 times.
    """
    turns = Counter[str]()

    def add(signal: rs.Signal[Any], raised: rs.Signal[Any], name: str) -> None:
        async def turn(ctx: Any) -> None:
            turns[name] += 1
            if not until() and turns[name] < 5_000:
                ctx.emit(raised)

        m.rule(when=signal, emits=raised, detached=True, name=name)(turn)

    for number, signal in enumerate(stages):
        add(signal, stages[(number + 1) % len(stages)], f"turn{number}")
    return turns


@pytest.mark.parametrize("stages", [1, 2, 3])
def test_an_endless_loop_does_not_keep_other_rules_from_running(play: Any, stages: int) -> None:
    m = rs.Module("m")
    a, out, heard = m.signal("a"), output(m), list[Any]()
    turns = endless(m, a, *(m.signal(f"b{n}") for n in range(1, stages)), until=lambda: bool(heard))
    writer(m, "fallback", a.where(lambda payload: payload == "input"), out)
    hearer(m, "speak", out.changed, out.changed, heard)
    with play(m) as sim:
        sim.emit(a, "input")
        assert written(sim, out) == ["fallback"]
        assert 1_000 <= turns.total() <= 1_010


def test_an_endless_loop_does_not_keep_a_rule_that_waits_for_pressure_from_running(play: Any) -> None:
    m = rs.Module("m")
    a, b, out, heard = m.signal("a"), m.signal("b"), output(m), list[Any]()
    turns = endless(m, a, until=lambda: bool(heard))
    hearer(m, "impatient", rs.pressure.true, rs.pressure.true, heard)
    writer(m, "alone", a.where(lambda payload: payload == "input"), out)
    writer(m, "both", a.where(lambda payload: payload == "input") & b, out)
    with play(m) as sim:
        sim.emit(a, "input")
        assert heard
        assert turns.total() < 1_010


def test_two_loops_take_turns(play: Any) -> None:
    m = rs.Module("m")
    a, b = m.signal("a"), m.signal("b")
    one = endless(m, a, until=lambda: one.total() > 2_000)
    n = rs.Module("n")
    other = endless(n, n.signal("c"), until=lambda: one.total() > 2_000)
    emitter(n, "start", b, n.signals[0])
    emitter(m, "both", m.signal("go"), a, b)
    with play(m, n) as sim:
        sim.emit(m.signals[-1])
        assert abs(one.total() - other.total()) < 10


def test_an_endless_loop_that_occurs_twice_is_reported_only_once(play: Any) -> None:
    m = rs.Module("m")
    a, b, errors = m.signal("a"), m.signal("b"), list[Any]()
    turns = endless(m, a, b, until=lambda: turns.total() % 3_000 == 0)
    hearer(m, "unlucky", b, b, [])
    hearer(m, "report", rs.error, rs.error, errors)
    with play(m) as sim:
        for _ in range(2):
            sim.emit(a)
        assert turns.total() == 6_000
        assert [failure.rule for failure in errors] == ["m:turn0"]
        [(name, error)] = sim.failures
        assert name == "m:turn0"
        assert isinstance(error, rs.RuleError)
        assert "m:turn0, m:turn1 triggered each other" in str(error)
        assert ".min_age(seconds)" in str(error)


def test_a_rule_that_fails_and_is_retried_endlessly_does_not_keep_other_rules_from_running(play: Any) -> None:
    m = rs.Module("m")
    a, out, heard, fails = m.signal("a"), output(m), list[Any](), Counter[str]()

    @m.rule(when=a)
    async def fail(ctx: Any) -> None:
        fails["m:fail"] += 1
        if not heard and fails.total() < 5_000:
            raise ValueError("again")

    emitter(m, "retry", rs.error, a, detached=True)
    writer(m, "answer", a.where(lambda payload: payload == "input"), out)
    hearer(m, "speak", out.changed, out.changed, heard)
    with play(m) as sim:
        sim.emit(a, "input")
        assert heard == ["answer"]
        assert fails.total() < 1_000


def test_thousands_of_spikes_from_one_run_are_not_reported_as_a_loop(play: Any) -> None:
    m = rs.Module("m")
    a, b, c, out = m.signal("a"), m.signal("b"), m.signal("c", limit=5_000), output(m)

    @m.rule(when=a, emits=(b, c), detached=True)
    async def spread(ctx: Any) -> None:
        for _ in range(2_000):
            ctx.emit(c)
        ctx.emit(b)

    hearer(m, "many", c, c, [])
    writer(m, "last", b, out)
    with play(m, trace=False) as sim:
        sim.emit(a)
        assert not sim.failures
        assert sim.fired.count("m:many") == 2_000


def test_inputs_from_outside_are_answered_during_an_endless_loop() -> None:
    m = rs.Module("m")
    a, b, out, enough = m.signal("a"), m.signal("b"), output(m), list[bool]()
    question = m.slot("question", "", input=True)
    turns = endless(m, a, b, until=lambda: bool(enough))
    emitter(m, "classify", question.changed, m.signal("classified"))
    writer(m, "answer", m.signals[-1], out)
    writer(m, "fallback", question.changed, out)

    async def talk() -> list[str]:
        answers: list[str] = []
        async with rs.Context(m) as context:
            context.emit(a)
            for number in range(2):
                context.put(question, str(number))
                answers.append(await context.next(out.changed, timeout=30.0))
            enough.append(True)
        return answers

    assert asyncio.run(talk()) == ["answer"] * 2
    assert 1_000 < turns.total() < 9_000  # the loop was still running at the last answer


def test_a_loop_that_branches_does_not_keep_other_rules_from_running(play: Any) -> None:
    m = rs.Module("m")
    a, b, out = m.signal("a"), m.signal("b"), output(m)
    turns, answered = Counter[str](), list[int]()

    @m.rule(when=a, emits=a, detached=True)
    async def branch(ctx: Any) -> None:
        turns["branch"] += 1
        if not answered and turns.total() < 20_000:
            ctx.emit(a)
            ctx.emit(a)

    @m.rule(when=b, writes=out)
    async def answer(ctx: Any) -> None:
        answered.append(turns.total())

    emitter(m, "classify", a.where(lambda payload: payload == "input"), b)
    with play(m, trace=False) as sim:
        sim.emit(a, "input")
        assert 1_000 <= answered[0] <= 1_600


def test_many_short_chains_in_one_instant_are_not_reported_as_an_endless_loop(play: Any) -> None:
    m = rs.Module("m")
    a, step = m.signal("a"), m.signal("step", payload=int)

    @m.rule(when=a, emits=step, detached=True)
    async def spread(ctx: Any) -> None:
        for _ in range(12_000):
            ctx.emit(step, 1)

    @m.rule(when=step, emits=step, detached=True)
    async def count_down(ctx: Any) -> None:
        if ctx.payload(step):
            ctx.emit(step, ctx.payload(step) - 1)

    with play(m, trace=False) as sim:
        sim.emit(a)
        assert not sim.failures
        assert sim.fired.count("m:count_down") == 24_000
