"""Tests as coroutines, on a loop of their own."""

import asyncio
import functools
from collections.abc import Callable, Coroutine
from typing import Any

LIMIT = 20
"""Seconds after which a test that waits for what never comes is ended; no test comes near."""


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
    """Let the loop turn a few times."""
    for _ in range(count):
        await asyncio.sleep(0)
