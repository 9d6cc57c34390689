"""The runs of plain functions, in worker threads."""

from __future__ import annotations

import asyncio
import contextlib
import functools
import logging
from collections.abc import Callable, Iterable
from time import monotonic
from typing import Any

from ravestate.runtime.rule_context import RuleContext
from ravestate.runtime.workers import Job, JobQueue

STARVED = 5.0
"""If a plain function has waited this many seconds for a thread, a warning names the rules that hold the threads."""

log = logging.getLogger("ravestate")


class PlainRules:
    """Starts and abandons the runs of one context's plain functions.

    When a function has ended, this class calls `finish` on the loop, with the run, the result and the exception.
    """

    def __init__(
        self, loop: asyncio.AbstractEventLoop, finish: Callable[[RuleContext, Any, BaseException | None], None]
    ) -> None:
        self.runs: dict[RuleContext, Job] = {}
        """Run whose function has not ended → the function's job in the thread pool."""
        self._loop = loop
        self._finish = finish
        self._queue = JobQueue()
        self._alarm: asyncio.TimerHandle | None = None
        self._warned = False

    def start(self, ctx: RuleContext) -> None:
        """Call a run's function in a worker thread."""
        try:
            self.runs[ctx] = self._queue.submit(functools.partial(self._call, ctx), ctx.rule.name)
        except RuntimeError as error:
            self._finish(ctx, None, error)
            return
        if self._alarm is None and self._queue.is_full():
            self._alarm = self._loop.call_later(STARVED, self._watch)

    def abandon(self, ctx: RuleContext) -> None:
        """Stop waiting for a run's function. The function keeps running, because a thread cannot be stopped."""
        self._queue.abandon(self.runs.pop(ctx))

    def close(self) -> None:
        """Stop waiting for all functions. Functions that have not begun are never called."""
        self.runs.clear()
        self._queue.close()
        if self._alarm is not None:
            self._alarm.cancel()

    def _call(self, ctx: RuleContext) -> None:
        """Call a run's function; this method runs in a worker thread."""
        if ctx.ended:
            return  # the run was cancelled before there was a thread for it
        result, exception = None, None
        try:
            result = ctx.rule.function(ctx)
        except BaseException as raised:  # a rule may raise anything
            exception = raised
        with contextlib.suppress(RuntimeError):  # the context has ended, and its loop is closed
            self._loop.call_soon_threadsafe(self._done, ctx, result, exception)

    def _done(self, ctx: RuleContext, result: Any, exception: BaseException | None) -> None:
        self.runs.pop(ctx, None)
        self._finish(ctx, result, exception)

    def _watch(self) -> None:
        """Warn if functions have waited for a thread for `STARVED` seconds; check again while any function waits."""
        waiting = [job for job in self.runs.values() if job.began is None]
        if not waiting:
            self._alarm, self._warned = None, False
            return
        longest = monotonic() - waiting[0].made
        if longest >= STARVED and not self._warned:
            self._warned = True
            holders = self._queue.holders()
            log.warning(
                "plain functions wait for a worker thread: %s. All %d threads are taken by %s. If a rule may hang, "
                "write timeout=seconds or async def",
                *(_listed(waiting), len(holders), _listed(holders)),
            )
        delay = STARVED if self._warned else STARVED - longest
        self._alarm = self._loop.call_later(delay, self._watch)


def _listed(jobs: Iterable[Job]) -> str:
    """Return the names of the jobs' rules as text, e.g. ``a:b (3 runs, up to 12 s), c:d (1 run, up to 5 s)``."""
    by_name: dict[str, list[float]] = {}
    for job in jobs:
        by_name.setdefault(job.name, []).append(monotonic() - (job.began or job.made))
    return ", ".join(
        f"{name} ({len(times)} run{'s'[: len(times) > 1]}, up to {max(times):.0f} s)" for name, times in by_name.items()
    )
