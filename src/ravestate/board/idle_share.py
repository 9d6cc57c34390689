"""How much of its time a process has to spare: whoever looks on may take of that, and little besides."""

from __future__ import annotations

from time import perf_counter, process_time

__all__ = ["IdleShare"]

SCHEDULE = "/proc/thread-self/schedstat"
"""Where Linux tells of a thread: nanoseconds that it ran, and that it was ready but had no processor."""


class IdleShare:
    """The share of time in which the process had nothing to do, since it was last asked; ask in one thread only.

    All of its threads count, so that several of them at work may hide that one rests: then there is nothing to spare.
    Time in which this thread would have computed, had other programs left it a processor, is not to spare either; on
    systems that do not tell (all but Linux) it counts as if it were.

    Example:
        >>> 0.0 <= IdleShare().share() <= 1.0
        True
    """

    __slots__ = ("_busy", "_kept", "_since")

    def __init__(self) -> None:
        self._since = perf_counter()
        self._busy = process_time()
        self._kept = _kept_waiting()

    def share(self) -> float:
        """From 0 (it computed all the time, or would have) to 1 (it did nothing)."""
        since, busy, kept = perf_counter(), process_time(), _kept_waiting()
        passed = since - self._since
        used = busy - self._busy + kept - self._kept
        self._since, self._busy, self._kept = since, busy, kept
        return min(1.0, max(0.0, 1.0 - used / passed)) if passed > 0 else 0.0


def _kept_waiting() -> float:
    """Seconds for which this thread was ready and had no processor."""
    try:
        with open(SCHEDULE, encoding="ascii") as file:
            return int(file.read().split()[1]) / 1e9
    except (OSError, ValueError, IndexError):
        return 0.0
