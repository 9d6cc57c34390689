"""L21: `until=condition` ends a running rule when spikes born after it began meet the condition."""

import asyncio
from collections.abc import Callable
from typing import Any

import pytest

import ravestate as rs
from laws.short import hearer, moments, outcomes, output, started, writer, written


def talker(
    until: Callable[[rs.Signal[Any], rs.Signal[Any], rs.Slot[str]], rs.Condition], **options: Any
) -> tuple[rs.Module, rs.Signal[Any], rs.Signal[Any], rs.Signal[Any], rs.Slot[str], rs.Slot[str]]:
    """Declare a rule that says one word per second for ten seconds. `until` combines two signals and a slot."""
    m = rs.Module("m")
    i, stop, hush = m.signal("i"), m.signal("stop", payload=object), m.signal("hush")
    mood, out = m.slot("mood", "patient"), output(m)

    @m.rule(when=i, writes=out, until=until(stop, hush, mood), **options)
    async def talk(ctx: Any) -> None:
        for second in range(10):
            ctx[out] = f"word {second}"
            await ctx.sleep(1.0)

    return m, i, stop, hush, mood, out


def test_a_run_ends_at_the_moment_at_which_its_condition_is_met(play: Any) -> None:
    m, i, stop, _, _, out = talker(lambda stop, hush, mood: stop)
    with play(m) as sim:
        sim.emit(i)
        sim.advance(2.5)
        sim.emit(stop)
        assert outcomes(sim) == [("talk", "interrupted")]
        sim.advance(20.0)
        assert written(sim, out) == ["word 0", "word 1", "word 2"]  # its writes so far stand
        assert sim.read(out) == "word 2"
        assert sim.failures == []


def test_an_interrupted_run_is_done(play: Any) -> None:
    m, i, stop, _, _, out = talker(lambda stop, hush, mood: stop)
    writer(m, "next_best", i, out, weight=0.5)
    with play(m) as sim:
        sim.emit(i)
        sim.emit(stop)
        sim.advance(20.0)
        assert (written(sim, out), sim.fired) == (["word 0"], ["m:talk"])


def test_an_interrupted_run_is_done_even_if_it_had_written_nothing(play: Any) -> None:
    m = rs.Module("m")
    i, stop, out = m.signal("i"), m.signal("stop"), output(m)

    @m.rule(when=i, writes=out, until=stop)
    async def ponder(ctx: Any) -> None:
        await ctx.sleep(10.0)

    writer(m, "next_best", i, out)
    with play(m) as sim:
        sim.emit(i)
        sim.advance(1.0)
        sim.emit(stop)
        sim.advance(20.0)
        assert (written(sim, out), sim.fired) == ([], ["m:ponder"])


def test_a_run_continues_if_its_condition_is_not_met(play: Any) -> None:
    m, i, _, hush, _, out = talker(lambda stop, hush, mood: stop)
    with play(m) as sim:
        sim.emit(i)
        sim.emit(hush)
        sim.advance(20.0)
        assert len(written(sim, out)) == 10
        assert outcomes(sim) == [("talk", "done")]


def test_spikes_born_before_the_run_do_not_count(play: Any) -> None:
    m, i, stop, _, _, out = talker(lambda stop, hush, mood: stop)
    hearer(m, "hold", stop.max_age(None) & m.signal("never"), stop, [])
    with play(m) as sim:
        sim.emit(stop)
        sim.emit(i)
        sim.advance(20.0)
        assert len(written(sim, out)) == 10


def test_a_rule_is_not_interrupted_by_the_spike_that_started_it(play: Any) -> None:
    m = rs.Module("m")
    text, out = m.slot("text", "", always=True), output(m)

    @m.rule(when=text.changed, writes=out, until=text.changed)
    async def answer(ctx: Any) -> None:
        await ctx.sleep(3.0)
        ctx[out] = f"re: {ctx.payload(text.changed)}"

    with play(m) as sim:
        sim.put(text, "one")
        sim.advance(2.0)
        sim.put(text, "two")  # barge-in: the first answer ends, and the second input gets a full answer
        assert outcomes(sim) == [("answer", "interrupted")]
        sim.advance(10.0)
        assert started(sim) == [(0.0, "answer"), (2.0, "answer")]
        assert moments(sim, out) == [(5.0, "re: two")]


def test_the_function_gets_the_chance_to_clean_up(play: Any) -> None:
    m = rs.Module("m")
    i, stop, out, ends = m.signal("i"), m.signal("stop"), output(m), list[Any]()

    @m.rule(when=i, writes=out, until=stop)
    async def talk(ctx: Any) -> None:
        try:
            await ctx.sleep(10.0)
        except asyncio.CancelledError:
            ctx[out] = "oh"
            await ctx.sleep(0.5)
            ctx[out] = "sorry"
            raise
        finally:
            ends.append(ctx.now)

    with play(m) as sim:
        sim.emit(i)
        sim.advance(2.0)
        sim.emit(stop)
        sim.advance(10.0)
        assert moments(sim, out) == [(2.0, "oh"), (2.5, "sorry")]
        assert ends == [2.5]
        assert outcomes(sim) == [("talk", "interrupted")]


@pytest.mark.parametrize("payload", [False, True])
def test_the_condition_can_have_predicates(play: Any, payload: bool) -> None:
    m, i, stop, _, _, _ = talker(lambda stop, hush, mood: stop.where(bool))
    with play(m) as sim:
        sim.emit(i)
        sim.emit(stop, payload)
        assert outcomes(sim) == ([("talk", "interrupted")] if payload else [])


def test_the_condition_can_be_a_conjunction(play: Any) -> None:
    m, i, stop, hush, _, _ = talker(lambda stop, hush, mood: stop & hush)
    with play(m) as sim:
        sim.emit(i)
        sim.emit(stop)
        sim.advance(1.0)
        assert outcomes(sim) == []
        sim.emit(hush)
        assert outcomes(sim) == [("talk", "interrupted")]


def test_the_condition_can_be_a_disjunction(play: Any) -> None:
    m, i, _, hush, _, _ = talker(lambda stop, hush, mood: stop | hush)
    with play(m) as sim:
        sim.emit(i)
        sim.emit(hush)
        assert outcomes(sim) == [("talk", "interrupted")]


def test_the_condition_can_require_an_age(play: Any) -> None:
    m, i, stop, _, _, out = talker(lambda stop, hush, mood: stop.min_age(2.0))
    with play(m) as sim:
        sim.emit(i)
        sim.advance(0.5)
        sim.emit(stop)
        sim.advance(20.0)
        assert len(written(sim, out)) == 3  # at 0, 1 and 2 s; ended at 2.5 s


def test_spikes_for_the_condition_grow_too_old(play: Any) -> None:
    m, i, stop, hush, _, out = talker(lambda stop, hush, mood: stop.max_age(1.0) & hush)
    with play(m) as sim:
        sim.emit(i)
        sim.emit(stop)
        sim.advance(2.0)
        sim.emit(hush)
        sim.advance(20.0)
        assert len(written(sim, out)) == 10


def test_the_condition_can_have_a_predicate_on_a_slot(play: Any) -> None:
    m, i, stop, _, mood, _ = talker(lambda stop, hush, mood: stop & mood.holds(lambda value: value == "impatient"))
    with play(m) as sim:
        sim.emit(i)
        sim.emit(stop)
        assert outcomes(sim) == []
        sim.put(mood, "impatient")
        sim.emit(stop)
        assert outcomes(sim) == [("talk", "interrupted")]


def test_the_predicate_on_a_slot_can_become_true_after_the_spike(play: Any) -> None:
    m, i, stop, _, mood, _ = talker(lambda stop, hush, mood: stop & mood.holds(lambda value: value == "impatient"))
    with play(m) as sim:
        sim.emit(i)
        sim.emit(stop)
        sim.advance(1.0)
        sim.put(mood, "impatient")
        assert outcomes(sim) == [("talk", "interrupted")]


def test_an_interruption_does_not_consume_its_spike(play: Any) -> None:
    m, i, stop, _, _, out = talker(lambda stop, hush, mood: stop)
    writer(m, "react", stop, out)
    with play(m) as sim:
        sim.emit(i)
        sim.emit(stop)
        sim.advance(1.0)
        assert written(sim, out) == ["word 0", "react"]


def test_the_condition_ends_every_run_that_watches_for_it(play: Any) -> None:
    m, i, stop, _, _, _ = talker(lambda stop, hush, mood: stop)
    with play(m) as sim:
        for _ in range(3):
            sim.emit(i)
        sim.emit(stop)
        assert outcomes(sim) == [("talk", "interrupted")] * 3
        sim.emit(i)
        sim.advance(1.0)
        assert len(outcomes(sim)) == 3


@pytest.mark.parametrize("held", [True, False])
def test_a_spike_wiped_before_it_is_old_enough_interrupts_no_run(play: Any, held: bool) -> None:
    m, i, stop, hush, _, out = talker(lambda stop, hush, mood: stop.min_age(2.0))
    if held:
        hearer(m, "hold", stop & hush, stop, [])
    with play(m) as sim:
        sim.emit(i)
        sim.emit(stop)
        sim.advance(1.0)
        sim.wipe(stop)
        sim.advance(20.0)
        assert outcomes(sim)[-1] == ("talk", "done")
        assert len(written(sim, out)) == 10
        assert sim.snapshot()["spikes"] == []


def test_a_spike_superseded_before_it_is_old_enough_interrupts_no_run(play: Any) -> None:
    m = rs.Module("m")
    i, gesture, out = m.signal("i"), m.signal("gesture", keep="latest"), output(m)
    writer(m, "talk", i, out, after=4.0, until=gesture.min_age(2.0))
    with play(m) as sim:
        sim.emit(i)
        sim.emit(gesture)
        sim.advance(1.5)
        sim.emit(gesture)
        sim.advance(1.5)
        assert outcomes(sim) == []
        sim.advance(1.0)
        assert (outcomes(sim), written(sim, out)) == ([("talk", "interrupted")], [])
