"""A recorder limits its memory and its work, and counts the spikes that it misses."""

import contextlib
import gc
import weakref
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

import ravestate as rs
from board.looking import in_virtual_time, passing
from ravestate.board.recorder import BATCH, Gap, Recorder, Recorders, fair_length
from ravestate.board.rendering import Rendered
from ravestate.engine.trace import Born, Settled


def ticking() -> tuple[rs.Context, rs.Signal[None]]:
    module = rs.Module("ticking")
    tick = module.signal("tick")

    @module.rule(when=tick)
    async def count(ctx: rs.RuleContext) -> None: ...

    return rs.Context(module), tick


@in_virtual_time
async def test_records_are_numbered_and_each_inspector_reads_them_once() -> None:
    context, tick = ticking()
    recorder = Recorder(context, whole=True)
    async with context:
        context.emit(tick)
        await passing(1)
        everything = recorder.since(0, 10_000)
        assert len(everything) == recorder.last
        assert recorder.since(recorder.last, 10) == []
        assert recorder.since(2, 3) == everything[2:5]
        assert recorder.since(recorder.last - 2, 10) == everything[-2:]
        assert recorder.first == 1


@in_virtual_time
async def test_a_full_recorder_drops_its_oldest_records() -> None:
    context, tick = ticking()
    recorder = Recorder(context, kept=50)
    async with context:
        for _ in range(100):
            context.emit(tick)
            await passing(1)
        assert len(recorder.records) == 50
        assert recorder.first == recorder.last - 49
        assert recorder.since(0, 1000) == list(recorder.records)


@in_virtual_time
async def test_a_recorder_that_gets_too_many_records_stops_and_counts_the_missed_spikes() -> None:
    context, tick = ticking()
    recorder = Recorder(context, burst=200, rate=100, spare=0)
    async with context:
        for _ in range(20):
            for _ in range(100):
                context.emit(tick)
            await passing(0.01)
        taken = recorder.last
        await passing(10)
        context.emit(tick)  # the number of this spike shows how many were missed
        await passing(1)
        gaps = [record for record in recorder.records if isinstance(record, Gap)]
        born = [record.spike for record in recorder.records if isinstance(record, Born)]
    assert taken < 400
    assert gaps
    assert all(gap.spikes >= 0 for gap in gaps)
    assert recorder.missed == sum(gap.spikes for gap in gaps) > 1000
    assert len(born) + recorder.missed == born[-1]  # each spike was recorded or counted as missed


@in_virtual_time
async def test_after_a_long_pause_another_burst_is_recorded_in_full() -> None:
    context, tick = ticking()
    recorder = Recorder(context, burst=500, rate=100, spare=0)
    async with context:
        for _ in range(3):
            for _ in range(50):
                context.emit(tick)
            await passing(60)
    assert recorder.missed == 0


@in_virtual_time
async def test_each_context_has_its_own_single_recorder() -> None:
    context, _ = ticking()
    other, _ = ticking()
    recorders = Recorders()
    recorder = recorders.of(context)
    assert recorders.of(context) is recorder is not recorders.of(other)


@in_virtual_time
async def test_a_recorder_is_freed_with_its_context() -> None:
    recorders = Recorders()
    gone: list[weakref.ref[Any]] = []
    for make in (recorders.of, lambda context: Recorder(context, burst=100)):
        context, tick = ticking()
        recorder = make(context)
        async with context:
            for _ in range(300):  # the second recorder has stopped recording when its context ends
                context.emit(tick)
            await passing(0.05)
        gone += [weakref.ref(context), weakref.ref(recorder)]
        del context, tick, recorder
    await passing(1)
    gc.collect()
    assert [known() for known in gone] == [None] * 4


@in_virtual_time
async def test_the_record_of_a_failure_keeps_neither_the_exception_nor_the_rules_variables() -> None:
    module = rs.Module("failing")
    tick = module.signal("tick")

    @module.rule(when=tick)
    async def fail(ctx: rs.RuleContext) -> None:
        raise ValueError("too dark")

    context = rs.Context(module)
    recorder = Recorder(context)
    async with context:
        context.emit(tick)
        await passing(1)
    [error] = [record.error for record in recorder.records if isinstance(record, Settled)]
    assert isinstance(error, str) and 'raise ValueError("too dark")' in error
    [payload] = [one.payload for one in recorder.records if isinstance(one, Born) and one.signal == "core:error"]
    assert isinstance(payload, Rendered) and "too dark" in payload.text


@in_virtual_time
async def test_all_recorders_together_stay_within_the_shared_limit() -> None:
    recorders = Recorders(in_all=3000)
    made = [ticking() for _ in range(20)]
    kept = [recorders.of(context, whole=True) for context, _ in made]
    async with contextlib.AsyncExitStack() as stack:
        for context, _ in made:
            await stack.enter_async_context(context)
        for number in range(60):
            for place, (context, tick) in enumerate(made):
                if place < 15 or number < 2:  # the last five contexts have few records
                    context.emit(tick)
            await passing(1)
            assert sum(len(recorder.records) for recorder in kept) <= 3000 * 1.02 + 20 * BATCH
        long, short = kept[:15], kept[15:]
        assert all(recorder.last > 250 and 100 < len(recorder.records) < 250 for recorder in long)
        assert all(len(recorder.records) == recorder.last for recorder in short)
        for recorder in kept:
            assert recorder.first == recorder.last - len(recorder.records) + 1
            assert recorder.since(recorder.last - 5, 10) == list(recorder.records)[-5:]
            assert recorder.since(0, 10_000) == list(recorder.records)


async def records_of_a_context_with_one_tick() -> int:
    context, tick = ticking()
    recorder = Recorder(context)
    async with context:
        context.emit(tick)
        await passing(1)
        return recorder.last


@in_virtual_time
async def test_missed_spikes_are_counted_correctly_even_if_no_earlier_spike_is_kept() -> None:
    taken = await records_of_a_context_with_one_tick()
    context, tick = ticking()
    recorder = Recorder(context, kept=1, burst=taken - 1, rate=0, spare=0)  # a burst begins after the first record
    async with context:
        context.emit(tick)
        await passing(1)
        assert recorder.last == taken + 1
        [gap] = recorder.records
        context.emit(tick)  # no spike was missed
        await passing(1)
    assert isinstance(gap, Gap)
    assert (gap.spikes, recorder.missed) == (0, 0)


@in_virtual_time
async def test_no_spike_after_a_gap_is_recorded_twice() -> None:
    context, tick = ticking()
    recorder = Recorder(context, burst=3, rate=0, spare=0)  # only a few records between two gaps
    async with context:
        for _ in range(30):
            for _ in range(3):
                context.emit(tick)
            await passing(1)
    born = [record.spike for record in recorder.records if isinstance(record, Born)]
    assert born == sorted(set(born))
    assert recorder.missed == born[-1] - len(born) > 0


@in_virtual_time
async def test_dropping_old_records_during_a_gap_adds_no_missed_spikes() -> None:
    context, tick = ticking()
    recorder = Recorder(context, burst=60, rate=0, spare=0)
    async with context:
        for _ in range(100):
            context.emit(tick)
        await passing(0.01)
        assert isinstance(recorder.records[-1], Gap)
        before = max(record.spike for record in recorder.records if isinstance(record, Born))
        recorder.shorten(20)  # as if another conversation needed the memory
        await passing(1)
        context.emit(tick)
        await passing(1)
    after = [record.spike for record in recorder.records if isinstance(record, Born) and record.spike > before]
    assert recorder.missed == after[0] - before - 1 > 30


@in_virtual_time
async def test_a_gap_counts_as_a_record() -> None:
    context, tick = ticking()
    grown: list[int] = []
    recorder = Recorder(context, burst=BATCH - 2, rate=0, spare=0, grown=lambda: grown.append(recorder.last))
    async with context:
        for _ in range(BATCH):
            context.emit(tick)
        await passing(0.01)
    assert isinstance(recorder.records[BATCH - 1], Gap)
    assert grown == [BATCH]


@pytest.mark.parametrize(
    ("lengths", "in_all", "fair"),
    [([], 10, 1), ([5, 3], 10, 5), ([5, 3], 6, 3), ([1, 9, 9], 11, 5), ([4] * 100, 50, 1), ([7], 3, 3)],
)
def test_the_longest_recorders_are_shortened_to_the_same_length(lengths: list[int], in_all: int, fair: int) -> None:
    assert fair_length(lengths, in_all) == fair


@given(st.lists(st.integers(0, 1000), min_size=1), st.integers(0, 5000))
def test_the_records_that_remain_nearly_fill_the_shared_limit(lengths: list[int], spare: int) -> None:
    in_all = len(lengths) + spare
    kept = sum(min(length, fair_length(lengths, in_all)) for length in lengths)
    assert min(sum(lengths), in_all - len(lengths)) <= kept <= in_all
