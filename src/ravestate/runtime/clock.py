"""A context's clock. It starts at zero and follows the loop's time. It can be halted, set forward and started again.

Another clock, such as the clock of a robot simulator, can drive it.
"""

from __future__ import annotations

import asyncio


class Clock:
    """A clock that counts the seconds since a context started, without the time in which the clock was halted.

    If another clock drives this one, this clock takes the other clock's time.
    """

    def __init__(self, loop: asyncio.AbstractEventLoop) -> None:
        self._loop = loop
        self._origin = loop.time()
        self._halted: float | None = None
        self._driven: float | None = None
        # future of a call of `sleep` → the time at which the call ends (seconds), and the call's timer
        self._sleepers: dict[asyncio.Future[None], tuple[float, asyncio.TimerHandle | None]] = {}

    def now(self) -> float:
        """Return the time on this clock (seconds)."""
        if self._halted is not None:
            return self._halted
        return self._loop.time() - self._origin if self._driven is None else self._driven

    def on_loop(self, time: float) -> float:
        """Convert a time on this clock to the loop's time (seconds). A later halt invalidates the result."""
        return self._origin + time

    @property
    def halted(self) -> bool:
        """Whether the clock is halted."""
        return self._halted is not None

    @property
    def driven(self) -> bool:
        """Whether another clock drives this one."""
        return self._driven is not None

    def drive(self, time: float) -> None:
        """Set the clock forward to `time` (seconds). From now on, it no longer follows the loop's time.

        A halted clock keeps its time until `go`, and then jumps to the time to which it was driven meanwhile.
        """
        self._driven = max(self.now() if self._driven is None else self._driven, time)
        for sleeper, (until, timer) in self._sleepers.items():
            if timer is not None:
                timer.cancel()
                self._sleepers[sleeper] = until, None
            if self._halted is None and until <= self._driven:
                _wake(sleeper)

    async def sleep(self, seconds: float) -> None:
        """Wait until `seconds` have passed on this clock; see `RuleContext.sleep`."""
        if seconds != seconds:
            raise ValueError("cannot sleep for nan seconds")
        if seconds <= 0:
            await asyncio.sleep(0)
            return
        future: asyncio.Future[None] = self._loop.create_future()
        until = self.now() + seconds
        timer = None
        if self._halted is None and self._driven is None:
            timer = self._loop.call_later(seconds, _wake, future)
        self._sleepers[future] = until, timer
        try:
            await future
        finally:
            _, timer = self._sleepers.pop(future)
            if timer is not None:
                timer.cancel()

    def next_waking(self) -> float | None:
        """Return the time (seconds) at which the next call of `sleep` ends; None if no code sleeps."""
        return min((until for until, _ in self._sleepers.values()), default=None)

    def halt(self) -> None:
        """Halt the clock. Calls of `sleep` do not end until the clock moves again."""
        if self._halted is None:
            self._halted = self.now()
            for sleeper, (until, timer) in self._sleepers.items():
                if timer is not None:
                    timer.cancel()
                self._sleepers[sleeper] = until, None

    def set(self, time: float) -> None:
        """Set a halted clock forward to `time` (seconds), and end the calls of `sleep` whose time has come."""
        if self._halted is not None:
            self._halted = max(self._halted, time)
            for sleeper, (until, _) in self._sleepers.items():
                if until <= self._halted:
                    _wake(sleeper)

    def go(self) -> None:
        """Start a halted clock again from its present time. If it was driven to a later time meanwhile, start there."""
        if self._halted is not None:
            present = self._halted
            self._origin = self._loop.time() - present
            self._halted = None
            if self._driven is not None:
                self.drive(max(self._driven, present))  # `set` may have set this clock beyond the driving clock
                return
            for sleeper, (until, _) in self._sleepers.items():
                timer = self._loop.call_at(self.on_loop(until), _wake, sleeper)
                self._sleepers[sleeper] = until, timer


def _wake(sleeper: asyncio.Future[None]) -> None:
    if not sleeper.done():
        sleeper.set_result(None)
