"""How much of its time a process has to spare: whoever looks on may take of that, and little besides."""

from __future__ import annotations

from time import perf_counter, process_time

__all__ = ["Leisure"]


class Leisure:
    """The share of time in which the process did not compute, since it was last asked.

    All of its threads count, so that several of them at work may hide that one rests: then there is nothing to spare.

    Example:
        >>> 0.0 <= Leisure().share() <= 1.0
        True
    """

    __slots__ = ("_busy", "_since")

    def __init__(self) -> None:
        self._since = perf_counter()
        self._busy = process_time()

    def share(self) -> float:
        """From 0 (it computed all the time) to 1 (it did nothing)."""
        since, busy = perf_counter(), process_time()
        passed = since - self._since
        used = busy - self._busy
        self._since, self._busy = since, busy
        return min(1.0, max(0.0, 1.0 - used / passed)) if passed > 0 else 0.0
