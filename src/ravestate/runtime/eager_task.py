"""A task for a coroutine that may end before it needs a task.

Making a task and switching to it takes more time than most rules take. So the first step of a coroutine runs outside
of any task, while a spare task counts as the current task. Thus `asyncio.current_task`, `asyncio.timeout` and context
variables work as usual. If the coroutine ends in its first step, the spare task is kept for the next coroutine. If the
coroutine suspends, the spare task adopts it.
"""

from __future__ import annotations

import asyncio
import contextvars
import types
from collections.abc import Coroutine, Generator
from typing import Any

from ravestate.declare.rule import Rule
from ravestate.runtime.blocking import StepTimer


class EagerTask:
    """A spare task. Once it has adopted the coroutine of a rule, it is the rule's task; the timer measures each step."""

    __slots__ = (
        "_abandoned", "_clean", "_context", "_coroutine", "_first", "_loop", "_rule", "_timer", "_wake", "task",
    )  # fmt: skip

    def __init__(self, loop: asyncio.AbstractEventLoop, timer: StepTimer) -> None:
        self._loop = loop
        self._timer = timer
        self._rule: Rule[Any, Any] | None = None
        self._coroutine: Coroutine[Any, Any, Any] | None = None
        self._first: Any = None
        self._abandoned = False
        self._wake: asyncio.Future[None] = loop.create_future()
        self._context = contextvars.copy_context()
        self._clean = self._context.copy()
        host = self._main()
        host.send(None)  # from now on, a cancellation reaches the host even before the task's first step
        self.task: asyncio.Task[Any] = loop.create_task(host, context=self._context)

    def first_step(self, coroutine: Coroutine[Any, Any, Any], rule: Rule[Any, Any]) -> None:
        """Run a coroutine to its end or to its first suspension. If it suspends, the task adopts it.

        Raises:
            StopIteration: The coroutine has ended. The spare task is free for another coroutine, unless it is `spoilt`.
            BaseException: The coroutine has failed with this exception. The spare task is free, as above.
        """
        around = asyncio.current_task(self._loop)  # a task may have called `step` on a paused context
        if around is not None:
            asyncio.tasks._leave_task(self._loop, around)  # pyright: ignore[reportPrivateUsage]
        asyncio.tasks._enter_task(self._loop, self.task)  # pyright: ignore[reportPrivateUsage]  # documented for task implementations
        began = self._timer.begin()
        try:
            self._first = self._context.run(coroutine.send, None)
        finally:
            asyncio.tasks._leave_task(self._loop, self.task)  # pyright: ignore[reportPrivateUsage]
            if around is not None:
                asyncio.tasks._enter_task(self._loop, around)  # pyright: ignore[reportPrivateUsage]
            self._timer.end(rule, began)
        self._coroutine = coroutine
        self._rule = rule
        if not self._wake.done():
            self._wake.set_result(None)

    @property
    def spoilt(self) -> bool:
        """Whether the last coroutine has cancelled its task, or has set a context variable."""
        return self.task.cancelling() > 0 or self._context != self._clean

    def close(self) -> None:
        """End the spare task, unless it has adopted a coroutine."""
        if self._coroutine is None:
            self.task.cancel()

    def abandon(self) -> None:
        """End the task although its coroutine does not end: close the coroutine where it is."""
        self._abandoned = True
        self.task.cancel()

    async def _main(self) -> Any:
        return await self._host()  # a task needs a coroutine, and the host must be free to yield anything

    @types.coroutine
    def _host(self) -> Generator[Any, Any, Any]:
        error: BaseException | None = None
        try:
            yield  # the task's first step continues here
            if self._coroutine is None:
                yield from self._wake
        except asyncio.CancelledError as cancelled:
            error = cancelled
        if self._coroutine is None:
            return None
        coroutine, rule = self._coroutine, self._rule
        assert rule is not None  # set together with the coroutine
        pending = self._first
        self._first = None
        if error is not None and pending is not None and pending.cancel():
            error = None  # the awaited future raises the cancellation, as in any task
        while True:
            value = None
            if error is None:
                try:
                    value = yield pending
                except GeneratorExit:
                    coroutine.close()
                    raise
                except BaseException as thrown:  # the loop throws this into the coroutine below
                    error = thrown
            if self._abandoned:
                coroutine.close()
                return None
            began = self._timer.begin()
            try:
                if error is None:
                    pending = coroutine.send(value)
                else:
                    thrown, error = error, None
                    pending = coroutine.throw(thrown)
            except StopIteration as stop:
                return stop.value
            except SystemExit as exit:  # if raised here, SystemExit would end the loop and all other rules
                return exit
            finally:
                self._timer.end(rule, began)
