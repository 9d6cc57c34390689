"""A token bucket, for rate limits."""

from __future__ import annotations


class Bucket:
    """A rate limit for events: a burst, then a fixed number per second.

    Args:
        burst: The maximum number of events in a burst.
        rate: The number of events per second after a burst.
        now: The present time (seconds on any clock, which `wait` and `take` use as well).

    Example:
        >>> bucket = Bucket(burst=2, rate=0.5, now=0.0)
        >>> [bucket.wait(now=0.0) for _ in range(3)]
        [0.0, 0.0, 2.0]
        >>> bucket.take(now=0.0)
        False
    """

    __slots__ = ("_burst", "_level", "_rate", "_time")

    def __init__(self, *, burst: float, rate: float, now: float) -> None:
        self._burst = burst
        self._rate = rate
        self._level = burst
        self._time = now

    def wait(self, now: float) -> float:
        """Count an event, even beyond the limit; return the seconds until the limit allows it, 0 if it does now."""
        self._fill(now)
        self._level -= 1
        return max(0.0, -self._level / self._rate)

    def take(self, now: float) -> bool:
        """Count an event if the limit allows it; return whether it does."""
        self._fill(now)
        if self._level < 1:
            return False
        self._level -= 1
        return True

    def _fill(self, now: float) -> None:
        self._level = min(self._burst, self._level + (now - self._time) * self._rate)
        self._time = now
