"""A task for a coroutine that may end before it needs a task.

To make a task and switch to it takes longer than most rules. So the first step of a coroutine runs outside
of any task, while a spare task counts as the current task. Thus `asyncio.current_task`, `asyncio.timeout` and context
variables work as usual. If the coroutine ends in its first step, the spare task is kept for the next coroutine. If the
coroutine suspends, the spare task adopts it.
"""

from __future__ import annotations

import asyncio
import contextvars
from asyncio.tasks import _enter_task, _leave_task  # pyright: ignore[reportPrivateUsage]  # documented for task implementations
from collections.abc import Callable, Generator
from typing import Any, Final

from ravestate.declare.rule import Rule
from ravestate.runtime.blocking import StepTimer
from ravestate.runtime.coroutines import DONE, Done, drive, host, main
from ravestate.runtime.rule_context import RuleContext

ENTER: Final = _enter_task  # the compiled build finds a constant at once, and looks an import up each time
LEAVE: Final = _leave_task
END: Final = DONE
KIND: Final = Done


class EagerTask:
    """A spare task. Once it has adopted the coroutine of a rule, it is the rule's task; the timer measures each step.

    The coroutine starts with the context variables `variables`. No other code sees its changes to these variables.

    Attributes:
        task: The task.
        rule: The rule whose coroutine the task has adopted, if it has adopted one.
        driver: The generator that runs the coroutine (`drive`).
        first: The object that the adopted coroutine has yielded in its first step.
        wake: A future that is done once the task has adopted a coroutine.
        abandoned: Whether the task is to end although its coroutine does not end.
    """

    __slots__ = (
        "_clean",
        "_context",
        "_loop",
        "_send",
        "abandoned",
        "driver",
        "first",
        "rule",
        "task",
        "timer",
        "wake",
    )

    def __init__(self, loop: asyncio.AbstractEventLoop, timer: StepTimer, variables: contextvars.Context) -> None:
        self._loop = loop
        self.timer = timer
        self.rule: Rule[Any, Any] | None = None
        self.first: Any = None
        self.abandoned = False
        self.wake: asyncio.Future[None] = loop.create_future()
        self._context = variables.copy()
        self._clean = variables
        self._renew()
        waiting: Any = host(self)
        waiting.send(None)  # from now on, a cancellation reaches the host even before the task's first step
        self.task: asyncio.Task[Any] = loop.create_task(main(waiting), context=self._context)

    def _renew(self) -> None:
        driver: Any = drive()
        driver.send(None)
        self.driver: Generator[Any, Any, Any] = driver
        self._send: Callable[[RuleContext], Any] = driver.send

    def first_step(self, ctx: RuleContext) -> Done | None:
        """Run a rule's function to its end or to its first suspension; no task may be current on the loop.

        Returns:
            The end of the function. The spare task is then free for another function, unless it is `spoilt`. None if
            the function's coroutine is suspended: then the task has adopted the coroutine.

        Raises:
            BaseException: The function has failed with this exception. The spare task is free, as above.
        """
        rule = ctx.rule
        ENTER(self._loop, self.task)
        began = self.timer.begin()
        try:
            first = self._context.run(self._send, ctx)
        except BaseException:
            self._renew()
            raise
        finally:
            LEAVE(self._loop, self.task)
            self.timer.end(rule, began)
        if first is END or type(first) is KIND:
            return first
        self.first = first
        self.rule = rule
        if not self.wake.done():
            self.wake.set_result(None)
        return None

    @property
    def spoilt(self) -> bool:
        """Whether the last function has cancelled its task, or has set a context variable."""
        return self.task.cancelling() > 0 or not are_equal(self._context, self._clean)

    def suits(self, variables: contextvars.Context) -> bool:
        """Return whether the task has these context variables."""
        return are_equal(self._clean, variables)

    def close(self) -> None:
        """End the spare task, unless it has adopted a coroutine."""
        if self.rule is None:
            self.task.cancel()

    def abandon(self) -> None:
        """End the task although its coroutine does not end: close the coroutine where it is."""
        self.abandoned = True
        self.task.cancel()


def are_equal(one: contextvars.Context, other: contextvars.Context) -> bool:
    """Return whether two sets of context variables are equal. Values that cannot be compared count as different."""
    if one is other:
        return True
    try:
        return one == other
    except Exception:  # a value's own comparison may raise anything
        return False
