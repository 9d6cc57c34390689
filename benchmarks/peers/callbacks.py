"""The floor: asyncio alone, without rules. Nothing that runs on asyncio can be faster."""

import asyncio
import time

from wire import serve

Seconds = float


def answer(k: int, inputs: int) -> list[Seconds]:
    """Measure k + 1 callbacks, each of which schedules the next; the last one wakes the caller."""

    async def measure() -> list[Seconds]:
        loop = asyncio.get_running_loop()

        def hop(left: int) -> None:
            if left:
                loop.call_soon(hop, left - 1)
            else:
                seen.set_result(None)

        times = []
        for _ in range(inputs):
            seen = loop.create_future()
            begin = time.perf_counter()
            loop.call_soon(hop, k)
            await seen
            times.append(time.perf_counter() - begin)
        return times

    return asyncio.run(measure())


def thread_hop(inputs: int) -> list[Seconds]:
    """Measure a bare hop into a worker thread and back."""

    async def measure() -> list[Seconds]:
        loop = asyncio.get_running_loop()
        times = []
        for _ in range(inputs):
            begin = time.perf_counter()
            await loop.run_in_executor(None, str)
            times.append(time.perf_counter() - begin)
        return times

    return asyncio.run(measure())


if __name__ == "__main__":
    serve(answer, thread_hop)
