"""The deadlines, in one heap. An entry becomes stale when its owner gets another deadline, or needs no deadline."""

from __future__ import annotations

import enum
import heapq
from collections.abc import Callable
from math import inf
from typing import Any


class Kind(enum.IntEnum):
    """A kind of deadline. Deadlines of the same time fall due in this order: gains before losses."""

    RIPEN = 0  # all spikes of an activation are old enough
    LOOK = 1  # a spike is old enough for a detached need
    RECHECK = 2  # the order of recovering utilities changes
    PATIENCE = 3  # the patience of a pressured rival ends
    EXPIRE = 4  # a spike is too old for an incomplete activation
    FORGET = 5  # a spike is too old for every detached need
    TIMEOUT = 6  # a run times out
    WATCH = 7  # the spikes of an `until` condition are old enough


# Reading an attribute of an enumeration costs more than using its value.
RIPEN, LOOK, RECHECK, PATIENCE, EXPIRE, FORGET, TIMEOUT, WATCH = Kind

Entry = tuple[float, Kind, int, Any]


class Deadlines:
    """A heap of (time in seconds, kind, number, owner); `valid` returns whether an entry still counts."""

    __slots__ = ("_count", "_heap", "_limit", "_valid", "earliest")

    def __init__(self, valid: Callable[[Entry], bool]) -> None:
        self.earliest = inf
        """A time (seconds) before which no entry is due."""
        self._heap: list[Entry] = []
        self._count = 0
        self._limit = 256
        self._valid = valid

    def add(self, time: float, kind: Kind, owner: Any) -> None:
        """Add an entry that is due at a time (seconds)."""
        self._count += 1
        if time < self.earliest:
            self.earliest = time
        heapq.heappush(self._heap, (time, kind, self._count, owner))
        if len(self._heap) > self._limit:  # remove stale entries before there are many
            self._heap = [entry for entry in self._heap if self._valid(entry)]
            heapq.heapify(self._heap)
            self._limit = max(256, 2 * len(self._heap))

    def next(self) -> float | None:
        """Return the time of the first valid entry (seconds); None if there is no valid entry."""
        heap = self._heap
        while heap and not self._valid(heap[0]):
            heapq.heappop(heap)
        self.earliest = heap[0][0] if heap else inf
        return self.earliest if heap else None

    def pop(self, now: float) -> Entry | None:
        """Remove the first valid entry, and return it, if it is due at `now` (seconds); else return None."""
        due = self.next()
        return heapq.heappop(self._heap) if due is not None and due <= now else None

    def __len__(self) -> int:
        return len(self._heap)
