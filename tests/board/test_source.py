"""Commands to a conversation, and callers that have gone."""

import asyncio
import contextlib
from collections.abc import Callable
from typing import Any

import pytest

from board.looking import in_virtual_time, passing
from ravestate.board.source import _outside_of_any_task  # pyright: ignore[reportPrivateUsage]


def fail() -> None:
    raise ValueError("no")


@in_virtual_time
async def test_a_call_outside_of_any_task_returns_its_result() -> None:
    assert await _outside_of_any_task(asyncio.current_task) is None
    with pytest.raises(ValueError, match="no"):
        await _outside_of_any_task(fail)


@pytest.mark.parametrize("work", [int, fail], ids=["done", "failed"])
@pytest.mark.parametrize("by_itself", [False, True], ids=["before", "by it"])
def test_a_call_may_end_after_its_caller_was_cancelled(work: Callable[[], object], by_itself: bool) -> None:
    @in_virtual_time
    async def test() -> None:
        said: list[Any] = []
        asyncio.get_running_loop().set_exception_handler(lambda _, context: said.append(context))
        called: list[bool] = []

        def call() -> object:
            called.append(True)
            if by_itself:
                asking.cancel()
            return work()

        asking = asyncio.create_task(_outside_of_any_task(call))
        if not by_itself:  # between the question and the answer
            asyncio.get_running_loop().call_soon(asking.cancel)
        await passing(1)
        with contextlib.suppress(asyncio.CancelledError):
            await asking
        assert (called, said, asking.cancelled()) == ([True], [], True)

    test()
