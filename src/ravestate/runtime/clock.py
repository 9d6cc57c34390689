"""A context's clock: its loop's, from zero. It can be halted, set forward while it stands, and started again."""

from __future__ import annotations

import asyncio

__all__ = ["Clock"]


class Clock:
    """Seconds since the context began, without those for which it stood still.

    Args:
        loop: Whose time it follows.
    """

    __slots__ = ("_halted", "_loop", "_origin", "_sleepers")

    def __init__(self, loop: asyncio.AbstractEventLoop) -> None:
        self._loop = loop
        self._origin = loop.time()
        self._halted: float | None = None
        self._sleepers: dict[asyncio.Future[None], tuple[float, asyncio.TimerHandle | None]] = {}

    def now(self) -> float:
        """The time (seconds)."""
        return self._loop.time() - self._origin if self._halted is None else self._halted

    def on_loop(self, time: float) -> float:
        """When it will be `time` (seconds) on the loop's clock, as long as this one is not halted."""
        return self._origin + time

    @property
    def halted(self) -> bool:
        """Whether it stands still."""
        return self._halted is not None

    async def sleep(self, seconds: float) -> None:
        """Wait until so many seconds have passed on this clock; 0 or less lets others have a turn.

        Raises:
            ValueError: NaN is no time.
        """
        if seconds != seconds:
            raise ValueError("cannot sleep for nan seconds")
        if seconds <= 0:
            await asyncio.sleep(0)
            return
        future: asyncio.Future[None] = self._loop.create_future()
        until = self.now() + seconds
        timer = None
        if self._halted is None:
            timer = self._loop.call_later(seconds, _wake, future)
        self._sleepers[future] = until, timer
        try:
            await future
        finally:
            _, timer = self._sleepers.pop(future)
            if timer is not None:
                timer.cancel()

    def next_waking(self) -> float | None:
        """When the first who sleeps will wake (seconds), if anybody sleeps."""
        return min((until for until, _ in self._sleepers.values()), default=None)

    def halt(self) -> None:
        """Stand still."""
        if self._halted is None:
            self._halted = self.now()
            for sleeper, (until, timer) in self._sleepers.items():
                if timer is not None:
                    timer.cancel()
                self._sleepers[sleeper] = until, None

    def set(self, time: float) -> None:
        """While it stands: make it `time` (seconds, not before what it is), and wake whose time has come."""
        if self._halted is not None:
            self._halted = max(self._halted, time)
            for sleeper, (until, _) in self._sleepers.items():
                if until <= self._halted:
                    _wake(sleeper)

    def go(self) -> None:
        """Go on from where it stands."""
        if self._halted is not None:
            self._origin = self._loop.time() - self._halted
            self._halted = None
            for sleeper, (until, _) in self._sleepers.items():
                timer = self._loop.call_at(self.on_loop(until), _wake, sleeper)
                self._sleepers[sleeper] = until, timer


def _wake(sleeper: asyncio.Future[None]) -> None:
    if not sleeper.done():
        sleeper.set_result(None)
