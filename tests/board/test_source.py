"""The board makes calls outside of any task. The task that requested a call can be cancelled meanwhile."""

import asyncio
import contextlib
from collections.abc import Callable
from typing import Any

import pytest

from board.looking import in_virtual_time, passing
from ravestate.board.source import outside_of_any_task


def fail() -> None:
    raise ValueError("no")


@in_virtual_time
async def test_a_call_outside_of_any_task_returns_its_result() -> None:
    assert await outside_of_any_task(asyncio.current_task) is None
    with pytest.raises(ValueError, match="no"):
        await outside_of_any_task(fail)


@pytest.mark.parametrize("work", [int, fail], ids=["call succeeds", "call fails"])
@pytest.mark.parametrize("by_the_call", [False, True], ids=["cancelled before the call", "cancelled by the call"])
def test_a_call_whose_caller_was_cancelled_still_ends_quietly(work: Callable[[], object], by_the_call: bool) -> None:
    @in_virtual_time
    async def test() -> None:
        said: list[Any] = []
        asyncio.get_running_loop().set_exception_handler(lambda _, context: said.append(context))
        called: list[bool] = []

        def call() -> object:
            called.append(True)
            if by_the_call:
                asking.cancel()
            return work()

        asking = asyncio.create_task(outside_of_any_task(call))
        if not by_the_call:  # cancel the caller between its request and the call
            asyncio.get_running_loop().call_soon(asking.cancel)
        await passing(1)
        with contextlib.suppress(asyncio.CancelledError):
            await asking
        assert (called, said, asking.cancelled()) == ([True], [], True)

    test()
