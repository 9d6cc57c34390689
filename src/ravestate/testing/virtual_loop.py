"""An asyncio loop whose time is virtual: it jumps to the next timer instead of waiting for it."""

from __future__ import annotations

import asyncio
import heapq
import selectors
from collections.abc import Callable
from contextvars import Context
from typing import Any

from ravestate.errors import EngineError

__all__ = ["VirtualLoop"]

REAL_LIMIT = 30.0
"""Real seconds that a plain function may keep virtual time waiting."""


class _Timer(asyncio.TimerHandle):
    """A timer that knows when it was set, among those for the same moment."""

    __slots__ = ("number",)
    number: int

    def __lt__(self, other: object) -> bool:
        if isinstance(other, _Timer):
            return (self.when(), self.number) < (other.when(), other.number)
        return NotImplemented


class VirtualLoop(asyncio.SelectorEventLoop):
    """Runs as fast as it can, until nothing is left to do before `goal`.

    Plain functions in threads take no virtual time: while `busy()` names some, or `asyncio.to_thread` runs one, the
    loop waits for them.
    """

    def __init__(self) -> None:
        self._virtual = 0.0
        self.goal: float | None = None
        """Virtual time at which `run_to` stops."""
        self.busy: Callable[[], list[str]] = list
        self._timers = 0
        self._endless = ""
        self._lent: dict[asyncio.Future[Any], str] = {}
        super().__init__(_Selector(self))

    def time(self) -> float:
        """Virtual seconds since the loop was made."""
        return self._virtual

    def run_in_executor(self, executor: Any, func: Callable[..., Any], *args: Any) -> asyncio.Future[Any]:
        """As in any loop; virtual time waits for the function."""
        future: asyncio.Future[Any] = super().run_in_executor(executor, func, *args)
        called = getattr(func, "args", (func,))[0]  # within the partials of asyncio.to_thread
        self._lent[future] = getattr(called, "__qualname__", repr(called))
        future.add_done_callback(lambda future: self._lent.pop(future, None))
        return future

    def kept_by(self) -> list[str]:
        """The names of the plain functions that are waited for."""
        return [*self.busy(), *self._lent.values()]

    def wait_no_more(self) -> None:
        """Do not wait for plain functions any more."""
        self.busy = list
        self._lent.clear()

    def call_at(
        self, when: float, callback: Callable[..., object], *args: Any, context: Context | None = None
    ) -> asyncio.TimerHandle:
        """As any loop does, but timers for the same moment go off in the order in which they were set."""
        self._check_closed()  # type: ignore[attr-defined]  # of BaseEventLoop
        self._timers += 1
        timer = _Timer(when, callback, args, self, context)
        timer.number = self._timers
        heapq.heappush(vars(self)["_scheduled"], timer)
        timer._scheduled = True  # pyright: ignore[reportAttributeAccessIssue]  # as BaseEventLoop marks it
        return timer

    def give_up(self, rule: str) -> None:
        """An instant does not end: stop, and let `run_to` raise."""
        self._endless = rule
        self.stop()

    def run_to(self, goal: float) -> None:
        """Run until all that happens at or before `goal` (virtual seconds) has happened."""
        self.goal = goal
        try:
            self.run_forever()
        finally:
            self.goal = None
        if self._endless:
            raise EngineError(
                f"at {self._virtual:g} s rules run without end, {self._endless} among them: a detached loop wants an age; "
                "write .min_age(seconds) behind the signal that it comes back by"
            )
        self._virtual = max(self._virtual, goal)

    def nothing_ready(self) -> None:
        """Called when only timers are left: jump to the next one, or stop."""
        timers: list[asyncio.TimerHandle] = vars(self)["_scheduled"]  # of BaseEventLoop
        due: float | None = timers[0].when() if timers else None
        if self.goal is not None and (due is None or due > self.goal):
            self._virtual = max(self._virtual, self.goal)
            self.stop()
        elif due is None:
            raise RuntimeError("everything waits for something that will never happen")
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
        busy = self._loop.kept_by()
        if busy:
            events = super().select(REAL_LIMIT)
            if not events:
                self._loop.wait_no_more()
                raise TimeoutError(
                    f"{' and '.join(busy)} kept virtual time waiting for {REAL_LIMIT:g} real seconds: a plain function "
                    "takes real time; to wait in virtual time write async def and await ctx.sleep(seconds)"
                )
            return events
        self._loop.nothing_ready()
        return []
