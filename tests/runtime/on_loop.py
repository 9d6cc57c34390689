"""Run a test that is a coroutine, on an event loop of its own."""

import asyncio
import functools
from collections.abc import Callable, Coroutine
from typing import Any

LIMIT = 60
"""Seconds after which a test that waits in vain fails; no other test takes so long."""


def on_loop(test: Callable[..., Coroutine[Any, Any, None]]) -> Callable[..., None]:
    """Run an async test function with `asyncio.run`."""

    @functools.wraps(test)
    def run(*arguments: Any, **named: Any) -> None:
        async def limited() -> None:
            async with asyncio.timeout(LIMIT):
                await test(*arguments, **named)

        asyncio.run(limited())

    return run


async def turns(count: int = 5) -> None:
    """Wait for a few turns of the loop."""
    for _ in range(count):
        await asyncio.sleep(0)
