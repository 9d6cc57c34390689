"""The timer of a runner: it fires at the engine's next deadline."""

from __future__ import annotations

import asyncio
from collections.abc import Callable

from ravestate.runtime.clock import Clock


class Timer:
    """A timer for one moment on a clock. At this moment, it calls `fire` with the moment's time (seconds)."""

    def __init__(self, loop: asyncio.AbstractEventLoop, clock: Clock, fire: Callable[[float], None]) -> None:
        self._loop = loop
        self._clock = clock
        self._fire = fire
        self._handle: asyncio.TimerHandle | None = None
        self._due = 0.0

    def set(self, due: float | None) -> None:
        """Fire at `due` (seconds; None: no timer), unless another clock drives the context's clock.

        A timer for an earlier time stays. If no deadline is left at that time, the engine does nothing.
        """
        if due is None or self._clock.driven or (self._handle is not None and self._due <= due):
            return
        self.clear()
        self._due = due
        self._handle = self._loop.call_at(self._clock.on_loop(due), self._wake)

    def clear(self) -> None:
        """Do not fire until the next call of `set`."""
        if self._handle is not None:
            self._handle.cancel()
            self._handle = None

    def _wake(self) -> None:
        self._handle = None
        self._fire(self._due)
