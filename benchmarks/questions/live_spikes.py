"""What does a spike cost when many are alive?

A spike is live until the engine removes it. Each of three shapes runs with 10,000 and with 100 live spikes:

- Burst: all spikes are raised at once, and one rule handles each.
- One more: the rule of the spikes waits for a second signal that never comes; further spikes arrive one by one.
- Beside: an input gets its answer while the spikes wait for the second signal.
"""

from __future__ import annotations

import asyncio
import statistics
import time
from collections.abc import Iterable

import ravestate as rs
from benchmarks.bench import Bench
from benchmarks.figures import Figure, compare
from benchmarks.peers.wire import serve

FEW, MANY = 100, 10_000
SAMPLE = 100
"""The number of further spikes, and of inputs, in one measurement."""


def burst(spikes: int) -> float:
    """Return the seconds for each spike of a burst, until all are handled."""

    async def measure() -> float:
        module = rs.Module("burst")
        ping = module.signal("ping", int, limit=spikes)
        handled: list[int] = []
        done = asyncio.Event()

        @module.rule(when=ping)
        async def handle(ctx: rs.RuleContext) -> None:
            handled.append(ctx.payload(ping))
            if len(handled) == spikes:
                done.set()

        async with rs.Context(module) as context:
            begin = time.perf_counter()
            for n in range(spikes):
                context.emit(ping, n)
            await done.wait()
            end = time.perf_counter()
        assert handled == list(range(spikes)), len(handled)
        return (end - begin) / spikes

    return asyncio.run(measure())


def in_wait(spikes: int) -> dict[str, float]:
    """Return the seconds for one more spike while `spikes` spikes wait, and for an answer while they wait."""

    async def measure() -> dict[str, float]:
        module = rs.Module("waiting")
        ping = module.signal("ping", int, limit=spikes + SAMPLE)
        never = module.signal("never")
        heard, output = module.slot("heard", ""), module.slot("output", "")

        @module.rule(when=ping.max_age(None) & never)
        async def both(ctx: rs.RuleContext) -> None:
            raise AssertionError("the second signal came, although it must not")

        @module.rule(when=heard.changed, reads=heard, writes=output)
        async def answer(ctx: rs.RuleContext) -> None:
            ctx[output] = f"answer {ctx[heard]}"

        async def emit(count: int) -> float:
            begin = time.perf_counter()
            for n in range(count):
                context.emit(ping, n)
                await asyncio.sleep(0)
            return (time.perf_counter() - begin) / count

        async with rs.Context(module) as context:
            await emit(spikes)
            one_more = await emit(SAMPLE)
            times = []
            for n in range(SAMPLE):
                begin = time.perf_counter()
                context.put(heard, f"word {n}")
                assert await context.next(output.changed) == f"answer word {n}"
                times.append(time.perf_counter() - begin)
        return {"one more": one_more, "answer": statistics.median(times)}

    return asyncio.run(measure())


def ask(bench: Bench) -> Iterable[Figure]:
    """Compare many live spikes with few."""
    ours = bench.ours("benchmarks.questions.live_spikes")
    bursts: dict[int, list[float]] = {FEW: [], MANY: []}
    more: dict[int, list[float]] = {FEW: [], MANY: []}
    beside: dict[int, list[float]] = {FEW: [], MANY: []}
    for _ in bench.rounds(7, 2):
        for spikes in (FEW, MANY):
            repeated = 10 if spikes == FEW else 1  # so few spikes take too little time for a measurement
            bursts[spikes].append(statistics.median(ours.ask("burst", spikes=spikes) for _ in range(repeated)))
            waits = [ours.ask("in_wait", spikes=spikes) for _ in range(repeated)]
            more[spikes].append(statistics.median(wait["one more"] for wait in waits))
            beside[spikes].append(statistics.median(wait["answer"] for wait in waits))
    rows = (("each of a burst of", bursts), ("one more beside", more), ("an answer beside", beside))
    for title, times in rows:
        yield compare(
            "live_spikes",
            f"{title} {MANY:,}",
            times[MANY],
            f"{title} {FEW}",
            times[FEW],
            target="about 1 (<= 1.1)",
            reach=lambda ratio: ratio <= 1.1,
        )


if __name__ == "__main__":
    serve(burst, in_wait)
