"""An asyncio loop whose time is virtual: it jumps to the next timer instead of waiting for it."""

from __future__ import annotations

import asyncio
import selectors
from collections.abc import Callable

__all__ = ["VirtualLoop"]

REAL_LIMIT = 30.0
"""Real seconds that a plain function may keep virtual time waiting."""


class VirtualLoop(asyncio.SelectorEventLoop):
    """Runs as fast as it can, until nothing is left to do before `goal`.

    Plain functions in worker threads take no virtual time: while `busy()` names some, the loop waits for them.
    """

    def __init__(self) -> None:
        self._virtual = 0.0
        self.goal: float | None = None
        """Virtual time at which `run_to` stops."""
        self.busy: Callable[[], list[str]] = list
        super().__init__(_Selector(self))

    def time(self) -> float:
        """Virtual seconds since the loop was made."""
        return self._virtual

    def run_to(self, goal: float) -> None:
        """Run until all that happens at or before `goal` (virtual seconds) has happened."""
        self.goal = goal
        try:
            self.run_forever()
        finally:
            self.goal = None
        self._virtual = max(self._virtual, goal)

    def nothing_ready(self) -> None:
        """Called when only timers are left: jump to the next one, or stop."""
        timers: list[asyncio.TimerHandle] = vars(self)["_scheduled"]  # of BaseEventLoop
        due: float | None = timers[0].when() if timers else None
        if self.goal is not None and (due is None or due > self.goal):
            self._virtual = self.goal
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
        busy = self._loop.busy()
        if busy:
            events = super().select(REAL_LIMIT)
            if not events:
                self._loop.busy = list  # nobody waits for it a second time
                raise TimeoutError(
                    f"{' and '.join(busy)} kept virtual time waiting for {REAL_LIMIT:g} real seconds: a plain function "
                    "takes real time; to wait in virtual time write async def and await ctx.sleep(seconds)"
                )
            return events
        self._loop.nothing_ready()
        return []
