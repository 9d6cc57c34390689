"""Run the first step of a coroutine without a task of its own. If the coroutine suspends, give it a task.

Making a task and switching to it takes longer than running most rules. So a coroutine gets a task of its own only if it
suspends. During its first step, a spare task counts as the current task. This way, `asyncio.current_task`,
`asyncio.timeout` and context variables work as usual. If the coroutine ends in its first step, the spare task remains
free for the next coroutine. If the coroutine suspends, the spare task adopts it.
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

ENTER: Final = _enter_task  # the compiled build looks an imported name up each time, but not a constant
LEAVE: Final = _leave_task
END: Final = DONE
KIND: Final = Done


class EagerTask:
    """A spare task. When it has adopted the coroutine of a rule, it is the rule's task. `timer` measures each step.

    The coroutine starts with the context variables `variables`. No other code sees the coroutine's changes to them.

    Attributes:
        task: The task.
        rule: The rule whose coroutine the task has adopted; None if the task is spare.
        driver: The generator that runs the coroutine (`drive`).
        first: The object that the adopted coroutine yielded at the end of its first step.
        wake: A future that is done as soon as the task has adopted a coroutine.
        abandoned: Whether to end the task before its coroutine has ended.
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
        waiting.send(
            None
        )  # start the generator now, so that a cancellation before the task's first step is raised inside it
        self.task: asyncio.Task[Any] = loop.create_task(main(waiting), context=self._context)

    def _renew(self) -> None:
        driver: Any = drive()
        driver.send(None)
        self.driver: Generator[Any, Any, Any] = driver
        self._send: Callable[[RuleContext], Any] = driver.send

    def first_step(self, ctx: RuleContext) -> Done | None:
        """Run a rule's function to its end or to its first suspension; no task may be current on the loop.

        Returns:
            If the function has ended: a `Done` with its result. The task is free for another function, unless it is
            `spoilt`. If the function's coroutine is suspended: None. The task has adopted the coroutine.

        Raises:
            BaseException: The function has raised this exception. The task is free, as after a function that has ended.
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
        """Whether the last function has cancelled the task, or has set a context variable."""
        return self.task.cancelling() > 0 or not are_equal(self._context, self._clean)

    def suits(self, variables: contextvars.Context) -> bool:
        """Return whether the task has these context variables."""
        return are_equal(self._clean, variables)

    def close(self) -> None:
        """End the spare task, unless it has adopted a coroutine."""
        if self.rule is None:
            self.task.cancel()

    def abandon(self) -> None:
        """End the task before its coroutine has ended: close the suspended coroutine."""
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
