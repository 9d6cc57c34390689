"""A token bucket: how often somebody may do something."""

from __future__ import annotations

__all__ = ["Bucket"]


class Bucket:
    """Lets through a burst, then so many a second.

    Args:
        burst: What may come at once.
        rate: What may come each second after that.
        now: The time (seconds).

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
        """Take one, also if there is none; the seconds until there would have been."""
        self._fill(now)
        self._level -= 1
        return max(0.0, -self._level / self._rate)

    def take(self, now: float) -> bool:
        """Take one if there is one; whether there was."""
        self._fill(now)
        if self._level < 1:
            return False
        self._level -= 1
        return True

    def _fill(self, now: float) -> None:
        self._level = min(self._burst, self._level + (now - self._time) * self._rate)
        self._time = now
