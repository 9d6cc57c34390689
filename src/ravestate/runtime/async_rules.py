"""The runs of async rules, on the event loop."""

from __future__ import annotations

import asyncio
import functools
import logging
from typing import TYPE_CHECKING, Any

from ravestate.declare.rule import Rule
from ravestate.runtime.eager_task import EagerTask
from ravestate.runtime.rule_context import RuleContext
from ravestate.runtime.spares import Spares

if TYPE_CHECKING:
    from ravestate.runtime.functions import Functions

GRACE = 5.0  # a cancelled rule has this many seconds to clean up; after that, its run counts as ended

CLEANING = 10
"""Cancelled rules have up to this many turns of the event loop for their last writes. Meanwhile, no effect is
performed; for instance, no rule starts.

If several rules are cancelled, the turns count from the first cancellation.
"""

log = logging.getLogger("ravestate")


class AsyncRules:
    """Starts, cancels and ends the async rules of one context.

    When the function of a run has ended, this class calls `Functions.finish`. If a run does not end within `GRACE`
    seconds of its cancellation, this class calls `Functions.drop`. When the tasks in `cleaning` have ended, or have
    used up their turns, it calls `Functions.go_on`, which performs the other effects.
    """

    def __init__(self, loop: asyncio.AbstractEventLoop, functions: Functions) -> None:
        self.cleaning: tuple[asyncio.Task[Any], ...] = ()
        """The tasks that have just been cancelled. Other effects wait until these tasks have made their last writes."""
        self._loop = loop
        self._functions = functions
        spares = Spares.join(loop)
        self._variables = spares.variables()
        self._spares: Spares | None = spares
        self._tasks: dict[RuleContext, EagerTask] = {}
        self._grace: dict[RuleContext, asyncio.TimerHandle] = {}
        self._spare: EagerTask | None = None

    def start(self, ctx: RuleContext) -> None:
        """Run a function to its end, or up to the first ``await`` that suspends it; a task continues from there.

        No task may be current on the loop. A caller that has no more functions to start must call `rest`.
        """
        task, self._spare = self._spare, None  # the function may start other functions
        if task is None:
            assert self._spares is not None  # no function starts after `close`
            task = self._spares.take(self._variables)
        try:
            end = task.first_step(ctx)
        except BaseException as exception:  # a rule may raise anything
            self._keep(task)
            self._functions.finish(ctx, None, exception)
            if isinstance(exception, KeyboardInterrupt):
                raise
            return
        if end is None:
            self._tasks[ctx] = task
            task.task.add_done_callback(functools.partial(self._done, ctx))
        else:
            self._keep(task)
            self._functions.finish(ctx, end.result, None)

    def _keep(self, task: EagerTask) -> None:
        """Keep a task as the spare for the next function.

        Close the task if there is a spare already, or if a function has spoilt the task (`EagerTask.spoilt`).
        """
        if self._spare is None and not task.spoilt:
            self._spare = task
        else:
            task.close()

    def rest(self) -> None:
        """Return the spare task, so that other contexts can use it."""
        if self._spare is not None and self._spares is not None:
            self._spares.give(self._spare)
            self._spare = None

    def cancel(self, ctx: RuleContext, reason: str) -> None:
        """Cancel a run, for a `reason`; the run has `GRACE` seconds to clean up."""
        task = self._tasks[ctx].task
        ctx.cancelled = reason
        task.cancel()
        self.cleaning = (*self.cleaning, task)
        if len(self.cleaning) == 1:
            self._loop.call_soon(self._wait_for_cleaning, CLEANING)
        self._grace[ctx] = self._loop.call_later(GRACE, self._grace_is_over, ctx)

    async def close(self, reason: str, *, at_once: bool) -> None:
        """Cancel all runs, and wait at most `GRACE` seconds for them to end; with `at_once`, do not wait.

        Then abandon the runs that have not ended.
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
        self.rest()
        if self._spares is not None:
            self._spares.leave()
            self._spares = None
        for timer in self._grace.values():
            timer.cancel()

    def _done(self, ctx: RuleContext, task: asyncio.Task[Any]) -> None:
        del self._tasks[ctx]
        grace = self._grace.pop(ctx, None)
        if grace is not None:
            grace.cancel()
        exception = asyncio.CancelledError() if task.cancelled() else task.exception()
        self._functions.finish(ctx, None if exception is not None else task.result(), exception)

    def _wait_for_cleaning(self, turns: int) -> None:
        if turns and not all(task.done() for task in self.cleaning):
            self._loop.call_soon(self._wait_for_cleaning, turns - 1)
        else:
            self.cleaning = ()
            self._functions.go_on()

    def _grace_is_over(self, ctx: RuleContext) -> None:
        del self._grace[ctx]
        _warn(ctx.rule)
        self._functions.drop(ctx, "it did not end in time")


def _warn(rule: Rule[Any, Any]) -> None:
    log.warning(
        "rule %s (%s) did not end within %g s of being cancelled: let asyncio.CancelledError through, and clean up quickly",
        rule.name,
        rule.origin,
        GRACE,
    )
