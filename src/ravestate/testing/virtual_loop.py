"""An asyncio loop in virtual time: it jumps to the next timer instead of waiting for it."""

from __future__ import annotations

import asyncio
import heapq
import selectors
from collections.abc import Callable
from contextvars import Context
from time import process_time
from typing import Any

from ravestate.errors import EngineError

REAL_LIMIT = 30.0  # virtual time waits this many real seconds for plain functions, or longer if they are computing
WORKING = 0.1  # plain functions that use at least this share of a processor are computing, and get more time
WORK_FACTOR = 10  # computing functions get up to this many times as long, so that a slow machine gives the same result


class _Timer(asyncio.TimerHandle):
    """A timer with a number: timers for the same time run in the order of their numbers."""

    __slots__ = ("number",)
    number: int

    def __lt__(self, other: object) -> bool:
        if isinstance(other, _Timer):
            return (self.when(), self.number) < (other.when(), other.number)
        return NotImplemented


class VirtualLoop(asyncio.SelectorEventLoop):
    """A loop that runs as fast as it can, until nothing is left to do at or before the time `goal`.

    Plain functions in threads take no virtual time. The loop waits for the functions that `busy()` names, and for those
    that `run_in_executor` runs, for instance through `asyncio.to_thread`.
    """

    is_virtual = True
    """Modules that connect to the world read this attribute. In virtual time, they make no connections."""

    def __init__(self) -> None:
        self._virtual = 0.0
        self.goal: float | None = None
        """The virtual time (seconds) at which `run_to` stops; None outside of `run_to`."""
        self.busy: Callable[[], list[str]] = list
        self._timers = 0
        self._endless = ""
        self._functions: dict[asyncio.Future[Any], str] = {}
        super().__init__(_Selector(self))

    def time(self) -> float:
        """Return the virtual seconds since the loop was created."""
        return self._virtual

    def run_in_executor(self, executor: Any, func: Callable[..., Any], *args: Any) -> asyncio.Future[Any]:
        """Run a function in a thread, as any loop does. Virtual time waits for the function."""
        future: asyncio.Future[Any] = super().run_in_executor(executor, func, *args)
        called = getattr(func, "args", (func,))[0]  # asyncio.to_thread passes a partial
        self._functions[future] = getattr(called, "__qualname__", repr(called))
        future.add_done_callback(lambda future: self._functions.pop(future, None))
        return future

    async def shutdown_default_executor(self, *args: Any, **named: Any) -> None:
        """Wait until the threads of the pool have ended. They end in real time, so virtual time waits for them."""
        closing = self.create_future()
        self._functions[closing] = "the shutdown of the thread pool"
        try:
            await super().shutdown_default_executor(*args, **named)
        finally:
            del self._functions[closing]

    def running_functions(self) -> list[str]:
        """Return the names of the plain functions for which virtual time waits."""
        return [*self.busy(), *self._functions.values()]

    def stop_waiting(self) -> None:
        """Stop waiting for the plain functions that run now."""
        self.busy = list
        self._functions.clear()

    def call_at(
        self, when: float, callback: Callable[..., object], *args: Any, context: Context | None = None
    ) -> asyncio.TimerHandle:
        """Set a timer. Timers for the same time run in the order in which they were set."""
        self._check_closed()  # type: ignore[attr-defined]  # a method of BaseEventLoop
        self._timers += 1
        timer = _Timer(when, callback, args, self, context)
        timer.number = self._timers
        heapq.heappush(vars(self)["_scheduled"], timer)
        timer._scheduled = True  # pyright: ignore[reportAttributeAccessIssue]  # as BaseEventLoop does
        return timer

    def give_up(self, rule: str) -> None:
        """Stop the loop, because rules repeat endlessly in one instant.

        `run_to` then raises an error that names `rule`.
        """
        self._endless = rule
        self.stop()

    def run_to(self, goal: float) -> None:
        """Run everything that is due at or before `goal` (virtual seconds)."""
        self.goal = goal
        try:
            self.run_forever()
        finally:
            self.goal = None
        if self._endless:
            raise EngineError(
                f"at {self._virtual:g} s, rules trigger each other without end, among them {self._endless}: add "
                ".min_age(seconds) to a signal of the loop, so that time passes"
            )
        self._virtual = max(self._virtual, goal)

    def on_idle(self) -> None:
        """Jump to the next timer, or stop if `goal` comes first. The loop calls this when only timers are left.

        If there is neither a timer nor a goal, raise a RuntimeError.
        """
        timers: list[asyncio.TimerHandle] = vars(self)["_scheduled"]  # an attribute of BaseEventLoop
        due: float | None = timers[0].when() if timers else None
        if self.goal is not None and (due is None or due > self.goal):
            self._virtual = max(self._virtual, self.goal)
            self.stop()
        elif due is None:
            raise RuntimeError("every task waits for something that never happens")
        else:
            self._virtual = max(self._virtual, due)


class _Selector(selectors.DefaultSelector):  # type: ignore[misc,valid-type]  # differs by platform
    def __init__(self, loop: VirtualLoop) -> None:
        super().__init__()
        self._loop = loop

    def select(self, timeout: float | None = None) -> list[tuple[selectors.SelectorKey, int]]:
        events = super().select(0)
        if events or (timeout is not None and timeout <= 0):
            return events
        busy = self._loop.running_functions()
        if busy:
            events = self._wait_for_functions()
            if not events:
                self._loop.stop_waiting()
                raise TimeoutError(
                    f"{' and '.join(busy)} kept virtual time waiting for over {REAL_LIMIT:g} real seconds: a plain function "
                    "takes real time; to wait in virtual time, write async def and await ctx.sleep(seconds)"
                )
            return events
        self._loop.on_idle()
        return []

    def _wait_for_functions(self) -> list[tuple[selectors.SelectorKey, int]]:
        events: list[tuple[selectors.SelectorKey, int]] = []
        for _ in range(WORK_FACTOR):
            begun = process_time()
            events = super().select(REAL_LIMIT)
            if events or process_time() - begun < WORKING * REAL_LIMIT:
                break
        return events
