"""How much memory does one more context hold, besides the shared policy?

Many contexts of one policy run on one loop, in real time. Each has answered inputs, and all spikes have aged. The figure
is the memory that tracemalloc counts, divided by the number of contexts.

Two other figures are processor times: to make and start 10,000 contexts, and for a full garbage collection with 100,000
contexts at rest.
"""

from __future__ import annotations

import asyncio
import gc
import time
import tracemalloc
from collections.abc import Iterable

import ravestate as rs
from benchmarks.bench import Bench
from benchmarks.figures import Figure, measured
from benchmarks.peers.ours import Agent
from benchmarks.peers.wire import serve

LIMIT = 5_000
"""Bytes that a context at rest may hold."""

AGED = 6.0
"""Seconds after which every spike of the agent is past its age (5 s)."""


def held(contexts: int, k: int, unrelated: int) -> float:
    """Return the bytes that each context holds."""

    async def measure() -> float:
        agent = Agent(k, unrelated)
        policy = rs.compile(agent.module)
        async with rs.Context(policy) as first:  # makes the objects that all contexts share
            await agent.turn(first, "warm", "answer warm")
        gc.collect()
        tracemalloc.start()
        before, _ = tracemalloc.get_traced_memory()
        agents = []
        for _ in range(contexts):
            context = rs.Context(policy)
            await context.__aenter__()
            for n in range(3):
                await agent.turn(context, f"word {n}", f"answer word {n}")
            agents.append(context)
        await asyncio.sleep(AGED)
        gc.collect()
        after, _ = tracemalloc.get_traced_memory()
        tracemalloc.stop()
        for context in agents:
            await context.stop()
        return (after - before) / contexts

    return asyncio.run(measure())


async def _start(policy: rs.Policy, count: int) -> list[rs.Context]:
    contexts = [rs.Context(policy) for _ in range(count)]
    for context in contexts:
        await context.start()
    await asyncio.sleep(0)
    return contexts


def made(contexts: int) -> float:
    """Return the seconds of processor time that new contexts take until they are at rest."""
    policy = rs.compile(Agent(1).module)
    gc.collect()
    loop = asyncio.new_event_loop()  # never closed: the process ends with its contexts
    begin = time.process_time()
    loop.run_until_complete(_start(policy, contexts))
    return time.process_time() - begin


def collected(contexts: int) -> float:
    """Return the seconds of processor time of a full collection: the least of three."""
    policy = rs.compile(Agent(1).module)
    kept = asyncio.new_event_loop().run_until_complete(_start(policy, contexts))
    gc.collect()
    times: list[float] = []
    for _ in range(3):
        begin = time.process_time()
        gc.collect()
        times.append(time.process_time() - begin)
    assert len(kept) == contexts
    return min(times)


def ask(bench: Bench) -> Iterable[Figure]:
    """Measure contexts of a small agent and of an agent with a thousand rules, and the two processor times."""
    contexts = bench.several(100, 30)
    for k, unrelated in ((1, 0), (8, 1000)):
        values = [
            bench.ours("benchmarks.questions.memory").ask("held", contexts=contexts, k=k, unrelated=unrelated)
            for _ in bench.rounds(3, 1)
        ]
        yield measured(
            "memory",
            f"a context at rest, {k + 2 + unrelated:,} rules",
            values,
            unit="B",
            target="< 5 kB",
            reach=lambda value: value < LIMIT,
        )
    for call, count, title, target in (
        ("made", 10_000, "10,000 contexts are made and started in", 0.5),
        ("collected", 100_000, "a full collection with 100,000 contexts takes", 0.6),
    ):
        values = [bench.ours("benchmarks.questions.memory").ask(call, contexts=count) for _ in bench.rounds(3, 1)]
        yield measured(
            "memory", title, values, target=f"<= {target:g} s", reach=lambda value, target=target: value <= target
        )


if __name__ == "__main__":
    serve(held, made, collected)
