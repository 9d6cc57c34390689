"""How evenly are many contexts served?

A thousand contexts of one policy run on one loop. First, inputs wait in all contexts, which gives the maximum number of
inputs a second. Then inputs come at half of this rate, each to a random context. The time of an input ends when its
answer is written. It begins when the input is due, even if the loop is busy then. The loop never sleeps, so the
benchmark uses the process's own clock, which leaves out the time of other programs.

Evenly spaced inputs show the delays that are ours: garbage collection, and the contexts' turns on the loop. Inputs at
random moments (exponential pauses) also wait for each other. The last figure compares our delays with those of an ideal
server, which gets the same inputs at the same moments. For each input, this server takes our time at full load.

The floor is a loop that does constant work at the same evenly spaced moments. The machine alone causes the delays in
this loop's slowest percent.
"""

from __future__ import annotations

import asyncio
import random
import time
from collections.abc import Iterable, Sequence

import ravestate as rs
from benchmarks.bench import Bench
from benchmarks.figures import Figure, compare, measured
from benchmarks.peers.wire import serve

CONTEXTS = 1_000
LIMIT = 3.0
"""The maximum of the 99th percentile, as a multiple of the median."""
STEPS, WARM = 1_000, 200
"""To measure the time of one step, the floor calls `add` with `STEPS` steps, `WARM` times."""


class Users:
    """Contexts of one policy, with the time of each answer."""

    def __init__(self) -> None:
        self.answered: list[float] = []
        self.left = 0
        self.done = asyncio.Event()
        module = rs.Module("users")
        self.heard = module.slot("heard", 0, always=True)
        output = module.slot("output", 0, always=True)
        asked = module.signal("asked", int)

        @module.rule(when=self.heard.changed, emits=asked)
        async def classify(ctx: rs.RuleContext) -> None:
            ctx.emit(asked, ctx.payload(self.heard.changed))

        @module.rule(when=asked, writes=output)
        async def answer(ctx: rs.RuleContext) -> None:
            number = ctx[output] = ctx.payload(asked)
            self.answered[number] = time.process_time()
            self.left -= 1
            if not self.left:
                self.done.set()

        @module.rule(when=self.heard.changed, writes=output)
        async def fallback(ctx: rs.RuleContext) -> None:
            raise AssertionError("the fallback ran, although the classifier had answered")

        self.policy = rs.compile(module)

    async def serve(self, contexts: Sequence[rs.Context], dues: Sequence[float]) -> list[float]:
        """Put an input into a random context at each of these times (seconds); return the seconds from each of these
        times to the answer."""
        chosen = random.Random(1).choices(contexts, k=len(dues))
        self.answered = [0.0] * len(dues)
        self.left = len(dues)
        self.done.clear()
        begin = time.process_time()
        for number, due in enumerate(dues):
            while time.process_time() < begin + due:  # noqa: ASYNC110  # a timer may be a millisecond late
                await asyncio.sleep(0)  # a timer of the loop would be late by up to a millisecond
            chosen[number].put(self.heard, number)
        await self.done.wait()
        return [end - begin - due for end, due in zip(self.answered, dues, strict=True)]


def load(inputs: int) -> dict[str, float]:
    """Return, in seconds, the time of an input at full load, and percentiles of the times at half load."""

    async def measure() -> dict[str, float]:
        users = Users()
        contexts = [rs.Context(users.policy) for _ in range(CONTEXTS)]
        for context in contexts:
            await context.start()
        await users.serve(contexts, [0.0] * inputs)
        full = max(await users.serve(contexts, [0.0] * inputs)) / inputs
        moments = [2 * full * number for number in range(inputs)]
        even, floor = await users.serve(contexts, moments), bare_loop(moments, full)
        dues, due, pauses = [], 0.0, random.Random(2)
        for _ in range(inputs):
            due += pauses.expovariate(1 / (2 * full))
            dues.append(due)
        mixed = await users.serve(contexts, dues)
        for context in contexts:
            await context.stop()
        return {
            "full": full,
            "even 50": percentile(even, 50),
            "even 99": percentile(even, 99),
            "floor 50": percentile(floor, 50),
            "floor 99": percentile(floor, 99),
            "random 50": percentile(mixed, 50),
            "random 99": percentile(mixed, 99),
            "server 99": percentile(constant_server(dues, full), 99),
        }

    return asyncio.run(measure())


def bare_loop(dues: Sequence[float], each: float) -> list[float]:
    """Do constant work of about `each` seconds at each of these times (seconds); return how long after its due time
    each work ends."""
    begin = time.process_time()
    for _ in range(WARM):
        add(STEPS)
    steps = round(STEPS * WARM * each / (time.process_time() - begin))
    times: list[float] = []
    begin = time.process_time()
    for due in dues:
        while time.process_time() < begin + due:
            pass
        add(steps)
        times.append(time.process_time() - begin - due)
    return times


def add(steps: int) -> int:
    """Do constant work: add the first numbers."""
    total = 0
    for number in range(steps):
        total += number
    return total


def constant_server(dues: Sequence[float], each: float) -> list[float]:
    """Return how long each input takes (seconds) if a server handles one input in `each` seconds."""
    free, times = 0.0, []
    for due in dues:
        free = max(free, due) + each
        times.append(free - due)
    return times


def percentile(times: Sequence[float], percent: int) -> float:
    """Return a percentile of some times."""
    return sorted(times)[len(times) * percent // 100]


def ask(bench: Bench) -> Iterable[Figure]:
    """Compare the slowest percent of the inputs with the median."""
    ours = bench.ours("benchmarks.questions.load")
    found: dict[str, list[float]] = {}
    for _ in bench.rounds(7, 2):
        for name, value in ours.ask("load", inputs=bench.several(20_000, 5_000)).items():
            found.setdefault(name, []).append(value)
    yield measured("load", f"{CONTEXTS:,} contexts at full load: an input", found["full"])
    yield compare(
        "load",
        "half load, even: 99 % within",
        found["even 99"],
        "50 % within",
        found["even 50"],
        target=f"<= {LIMIT:g}",
        reach=lambda ratio: ratio <= LIMIT,
    )
    yield compare("load", "bare loop, even: 99 % within", found["floor 99"], "50 % within", found["floor 50"])
    yield compare("load", "half load, random: 99 % within", found["random 99"], "50 % within", found["random 50"])
    yield compare(
        "load", "half load, random: 99 % within", found["random 99"], "a server of constant time", found["server 99"]
    )


if __name__ == "__main__":
    serve(load)
