"""A task for a coroutine that may turn out not to need one.

Making a task and having the loop switch to it costs more than most rules take. So the first step of a
coroutine is driven by hand, while a spare task counts as the current one (`asyncio.current_task`,
`asyncio.timeout` and the like work as they should). If the coroutine ends in its first step, the spare is kept
for the next; if it suspends, the spare adopts it.
"""

from __future__ import annotations

import asyncio
import types
from collections.abc import Callable, Coroutine, Generator
from time import perf_counter
from typing import Any

__all__ = ["Nest"]


class Nest:
    """One spare task, and what it is to drive once it has adopted a coroutine.

    Args:
        loop: The loop of the task.
        blocked: Called with the owner of the coroutine and the seconds that a single step of it took.
    """

    __slots__ = ("_blocked", "_coroutine", "_first", "_loop", "_owner", "_wake", "task")

    def __init__(self, loop: asyncio.AbstractEventLoop, blocked: Callable[[Any, float], None]) -> None:
        self._loop = loop
        self._blocked = blocked
        self._owner: Any = None
        self._coroutine: Coroutine[Any, Any, Any] | None = None
        self._first: Any = None
        self._wake: asyncio.Future[None] = loop.create_future()
        self.task: asyncio.Task[Any] = loop.create_task(self._host())  # type: ignore[arg-type]  # a generator-based coroutine

    def first_step(self, coroutine: Coroutine[Any, Any, Any], owner: Any) -> None:
        """Drive a coroutine to its end or to its first suspension, where the task adopts it.

        Raises:
            StopIteration: It has ended; the nest is as good as new.
            BaseException: What it raised; the nest is as good as new.
        """
        asyncio.tasks._enter_task(self._loop, self.task)  # pyright: ignore[reportPrivateUsage]  # documented for task implementations
        try:
            self._first = coroutine.send(None)
        finally:
            asyncio.tasks._leave_task(self._loop, self.task)  # pyright: ignore[reportPrivateUsage]
        self._coroutine = coroutine
        self._owner = owner
        if not self._wake.done():
            self._wake.set_result(None)

    def close(self) -> None:
        """End the spare task, if it has adopted nothing."""
        if self._coroutine is None:
            self.task.cancel()

    @types.coroutine
    def _host(self) -> Generator[Any, Any, Any]:
        error: BaseException | None = None
        while self._coroutine is None:
            try:
                yield from self._wake
            except asyncio.CancelledError as cancelled:
                if self._coroutine is None:
                    return None
                error = cancelled
        coroutine = self._coroutine
        pending = self._first
        self._first = None
        while True:
            value = None
            if error is None:
                try:
                    value = yield pending
                except GeneratorExit:
                    coroutine.close()
                    raise
                except BaseException as thrown:  # handed on to the coroutine
                    error = thrown
            began = perf_counter()
            try:
                if error is None:
                    pending = coroutine.send(value)
                else:
                    thrown, error = error, None
                    pending = coroutine.throw(thrown)
            except StopIteration as stop:
                return stop.value
            finally:
                self._blocked(self._owner, perf_counter() - began)
