"""The runs of async rules, on the event loop."""

from __future__ import annotations

import asyncio
import functools
import logging
from collections.abc import Callable
from typing import Any

from ravestate.declare.rule import Rule
from ravestate.runtime.blocking import StepTimer
from ravestate.runtime.eager_task import EagerTask
from ravestate.runtime.rule_context import RuleContext

GRACE = 5.0  # the seconds that a cancelled rule has to clean up before its run counts as ended

CLEANING = 10
"""The turns of the event loop that a cancelled rule has for its last writes before any other rule continues."""

log = logging.getLogger("ravestate")


class AsyncRules:
    """Starts, cancels and ends the async rules of one context.

    When a run's function has ended, this class calls `finish` with the run, its result and its exception. If a run does
    not end within `GRACE` seconds of its cancellation, this class calls `give_up` with the run and the reason. It calls
    `proceed` when the tasks in `cleaning` have ended, or when their turns are over.
    """

    def __init__(
        self,
        loop: asyncio.AbstractEventLoop,
        finish: Callable[[RuleContext, Any, BaseException | None], None],
        give_up: Callable[[RuleContext, str], None],
        proceed: Callable[[], None],
    ) -> None:
        self.cleaning: list[asyncio.Task[Any]] = []
        """The tasks that have just been cancelled. Their last writes come before any other effect."""
        self._loop = loop
        self._finish = finish
        self._give_up = give_up
        self._proceed = proceed
        self._timer = StepTimer()
        self._tasks: dict[RuleContext, EagerTask] = {}
        self._grace: dict[RuleContext, asyncio.TimerHandle] = {}
        self._spare: EagerTask | None = None

    def start(self, ctx: RuleContext) -> None:
        """Run a function up to its first ``await`` that suspends it. A task continues from there."""
        task = self._spare
        if task is None:
            task = self._spare = EagerTask(self._loop, self._timer)
        try:
            task.first_step(ctx.rule.function(ctx), ctx.rule)
        except StopIteration as stop:
            self._finish(ctx, stop.value, None)
        except BaseException as exception:  # a rule may raise anything
            self._finish(ctx, None, exception)
            if isinstance(exception, KeyboardInterrupt):
                raise
        else:
            self._spare = None
            self._tasks[ctx] = task
            task.task.add_done_callback(functools.partial(self._done, ctx))
        if task is self._spare and task.spoilt:
            task.close()
            self._spare = None

    def cancel(self, ctx: RuleContext, reason: str) -> None:
        """Cancel a run, for a `reason`; the run has `GRACE` seconds to clean up."""
        task = self._tasks[ctx].task
        ctx.cancelled = reason
        task.cancel()
        self.cleaning.append(task)
        if len(self.cleaning) == 1:
            self._loop.call_soon(self._wait_for_cleaning, CLEANING)
        self._grace[ctx] = self._loop.call_later(GRACE, self._grace_is_over, ctx)

    async def close(self, reason: str, *, at_once: bool) -> None:
        """Cancel all runs, and wait at most `GRACE` seconds until they end. Then abandon the runs that have not ended.

        With `at_once`, do not wait.
        """
        for ctx, task in self._tasks.items():
            ctx.cancelled = reason
            task.task.cancel()
        if self._tasks:
            tasks = [task.task for task in self._tasks.values()]
            await asyncio.wait(tasks, timeout=0 if at_once else GRACE)
        for ctx, task in self._tasks.items():
            if not at_once and not ctx.ended:
                _warn(ctx.rule)
            task.abandon()
        if self._spare is not None:
            self._spare.close()
        for timer in self._grace.values():
            timer.cancel()

    def _done(self, ctx: RuleContext, task: asyncio.Task[Any]) -> None:
        del self._tasks[ctx]
        grace = self._grace.pop(ctx, None)
        if grace is not None:
            grace.cancel()
        exception = asyncio.CancelledError() if task.cancelled() else task.exception()
        self._finish(ctx, None if exception is not None else task.result(), exception)

    def _wait_for_cleaning(self, turns: int) -> None:
        if turns and not all(task.done() for task in self.cleaning):
            self._loop.call_soon(self._wait_for_cleaning, turns - 1)
        else:
            self.cleaning.clear()
            self._proceed()

    def _grace_is_over(self, ctx: RuleContext) -> None:
        del self._grace[ctx]
        _warn(ctx.rule)
        self._give_up(ctx, "it did not end in time")


def _warn(rule: Rule[Any, Any]) -> None:
    log.warning(
        "rule %s (%s) did not end within %g s of being cancelled: let asyncio.CancelledError through, and clean up quickly",
        rule.name,
        rule.origin,
        GRACE,
    )
