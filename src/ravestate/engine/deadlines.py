"""One heap of deadlines. An entry is stale once its owner no longer stands by it."""

from __future__ import annotations

import enum
import heapq
from collections.abc import Callable
from typing import Any

__all__ = [
    "EXPIRE",
    "FORGET",
    "PATIENCE",
    "RECHECK",
    "RIPEN",
    "STANDBY",
    "TIMEOUT",
    "WATCH",
    "Deadlines",
    "Entry",
    "Kind",
]


class Kind(enum.IntEnum):
    """What is due; at one moment in this order: what becomes possible before what is given up."""

    RIPEN = 0  # an activation's spikes are old enough
    RECHECK = 1  # recovering utilities change places
    PATIENCE = 2  # a pressed activation has had its time
    STANDBY = 3  # a pressed stand-by rival has had its time
    EXPIRE = 4  # an activation gives a spike up for age
    FORGET = 5  # a spike that detached needs might have looked at is too old for all of them
    TIMEOUT = 6  # a run has taken too long
    WATCH = 7  # the spikes of an `until` are old enough


# An attribute of an enumeration costs more than what is done with it.
RIPEN, RECHECK, PATIENCE, STANDBY, EXPIRE, FORGET, TIMEOUT, WATCH = Kind

Entry = tuple[float, Kind, int, Any]


class Deadlines:
    """A heap of (time, kind, number, owner); `valid` says whether an entry still counts."""

    __slots__ = ("_count", "_heap", "_limit", "_valid")

    def __init__(self, valid: Callable[[Entry], bool]) -> None:
        self._heap: list[Entry] = []
        self._count = 0
        self._limit = 256
        self._valid = valid

    def add(self, time: float, kind: Kind, owner: Any) -> None:
        """Add an entry (seconds)."""
        self._count += 1
        heapq.heappush(self._heap, (time, kind, self._count, owner))
        if len(self._heap) > self._limit:  # rid the heap of stale entries before they are many
            self._heap = [entry for entry in self._heap if self._valid(entry)]
            heapq.heapify(self._heap)
            self._limit = max(256, 2 * len(self._heap))

    def pending(self, now: float) -> bool:
        """Whether an entry, stale or not, is due."""
        return bool(self._heap) and self._heap[0][0] <= now

    def next(self) -> float | None:
        """The time of the first valid entry."""
        heap = self._heap
        while heap and not self._valid(heap[0]):
            heapq.heappop(heap)
        return heap[0][0] if heap else None

    def pop(self, now: float) -> Entry | None:
        """Take the first valid entry that is due."""
        due = self.next()
        return heapq.heappop(self._heap) if due is not None and due <= now else None

    def __len__(self) -> int:
        return len(self._heap)
