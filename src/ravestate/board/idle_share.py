"""The idle share of a process: inspectors and recorders use part of the idle time, so that the agent comes first."""

from __future__ import annotations

from time import perf_counter, process_time

SCHEDULE = "/proc/thread-self/schedstat"
"""The file in which Linux counts a thread's nanoseconds on a processor and in the queue for one."""


class IdleShare:
    """Measures the share of time in which the process was idle since the last `share` call. Use it in one thread only.

    The processor time of all threads counts as busy. Time in which this thread waited for a processor counts as busy,
    too, where the system measures it (Linux).

    Example:
        >>> 0.0 <= IdleShare().share() <= 1.0
        True
    """

    def __init__(self) -> None:
        self._since = perf_counter()
        self._busy = process_time()
        self._kept = _kept_waiting()

    def share(self) -> float:
        """Return the idle share since the last call, from 0 (always busy) to 1 (always idle)."""
        since, busy, kept = perf_counter(), process_time(), _kept_waiting()
        passed = since - self._since
        used = busy - self._busy + kept - self._kept
        self._since, self._busy, self._kept = since, busy, kept
        return min(1.0, max(0.0, 1.0 - used / passed)) if passed > 0 else 0.0


def _kept_waiting() -> float:
    """Return the seconds for which this thread has waited for a processor so far; 0 if the system does not know."""
    try:
        with open(SCHEDULE, encoding="ascii") as file:
            return int(file.read().split()[1]) / 1e9
    except (OSError, ValueError, IndexError):
        return 0.0
