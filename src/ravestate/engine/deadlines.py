"""The deadlines: one heap. An entry is stale once its owner has another deadline, or none."""

from __future__ import annotations

import enum
import heapq
from collections.abc import Callable
from typing import Any


class Kind(enum.IntEnum):
    """A kind of deadline. At one moment they fall due in this order: first gains, then losses."""

    RIPEN = 0  # an activation's spikes are old enough
    RECHECK = 1  # recovering utilities change places
    PATIENCE = 2  # the patience of a pressured activation ends
    STANDBY = 3  # the patience of a pressured stand-by rival ends
    EXPIRE = 4  # an activation gives a spike up for age
    FORGET = 5  # a spike is too old for every detached need
    TIMEOUT = 6  # a run times out
    WATCH = 7  # the spikes of an `until` are old enough


# Reading an attribute of an enumeration costs more than using its value.
RIPEN, RECHECK, PATIENCE, STANDBY, EXPIRE, FORGET, TIMEOUT, WATCH = Kind

Entry = tuple[float, Kind, int, Any]


class Deadlines:
    """A heap of (time in seconds, kind, number, owner); `valid` says whether an entry still counts."""

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
        if len(self._heap) > self._limit:  # remove stale entries before there are many
            self._heap = [entry for entry in self._heap if self._valid(entry)]
            heapq.heapify(self._heap)
            self._limit = max(256, 2 * len(self._heap))

    def pending(self, now: float) -> bool:
        """Return whether an entry, stale or not, is due."""
        return bool(self._heap) and self._heap[0][0] <= now

    def next(self) -> float | None:
        """Return the time of the first valid entry (seconds)."""
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
