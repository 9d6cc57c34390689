"""Run an async test function on its own event loop."""

import asyncio
import functools
from collections.abc import Callable, Coroutine
from typing import Any

LIMIT = 60
"""The time after which a test that still waits has failed (seconds). All tests normally take much less."""


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
