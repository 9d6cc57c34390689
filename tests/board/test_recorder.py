"""The recorder: bounded in memory and in what it costs, and it says what it has missed."""

import ravestate as rs
from board.looking import in_virtual_time, passing
from ravestate.board.recorder import Gap, Recorder, Recorders
from ravestate.engine.trace import Born


def ticking() -> tuple[rs.Context, rs.Signal[None]]:
    module = rs.Module("ticking")
    tick = module.signal("tick")

    @module.rule(when=tick)
    async def count(ctx: rs.RuleContext) -> None: ...

    return rs.Context(module), tick


@in_virtual_time
async def test_records_are_numbered_and_read_by_whoever_has_not_seen_them() -> None:
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
async def test_memory_is_bounded_and_the_oldest_goes_first() -> None:
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
async def test_beyond_its_rate_it_stops_listening_and_counts_the_spikes_that_it_missed() -> None:
    context, tick = ticking()
    recorder = Recorder(context, burst=200, rate=100, spare=0)
    async with context:
        for _ in range(20):
            for _ in range(100):
                context.emit(tick)
            await passing(0.01)
        taken = recorder.last
        await passing(10)
        context.emit(tick)  # whose number tells how many went unseen
        await passing(1)
        gaps = [record for record in recorder.records if isinstance(record, Gap)]
        born = [record.spike for record in recorder.records if isinstance(record, Born)]
    assert taken < 400
    assert gaps
    assert all(gap.spikes >= 0 for gap in gaps)
    assert recorder.missed == sum(gap.spikes for gap in gaps) > 1000
    assert len(born) + recorder.missed == born[-1]  # every spike was either seen or counted


@in_virtual_time
async def test_a_long_pause_earns_a_burst_again() -> None:
    context, tick = ticking()
    recorder = Recorder(context, burst=500, rate=100, spare=0)
    async with context:
        for _ in range(3):
            for _ in range(50):
                context.emit(tick)
            await passing(60)
    assert recorder.missed == 0


@in_virtual_time
async def test_who_listens_no_more_costs_nothing() -> None:
    context, tick = ticking()
    recorders = Recorders()
    async with context:
        recorder = recorders.of(context)
        assert recorders.of(context) is recorder
        recorder.close()
        context.emit(tick)
        await passing(1)
        assert recorder.last == 0
