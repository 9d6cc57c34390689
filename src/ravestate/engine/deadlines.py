"""The deadlines, in one heap. An entry becomes stale when its owner gets another deadline, or needs no deadline.

A table, `DEADLINES` in ``engine.py``, has two functions for each kind: whether an entry still counts, and what to do
when it is due.
"""

from __future__ import annotations

import enum
import heapq
from collections.abc import Callable, Sequence
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
Table = Sequence[tuple[Callable[[Any, float, Any], bool], Callable[[Any, float, Any], None]]]
"""For each kind: a function for entries that still count, and one for entries that are due. Both get the engine, the time
(seconds) and the owner of an entry."""


class Deadlines:
    """A heap of (time in seconds, kind, number, owner) of one engine."""

    __slots__ = ("_count", "_engine", "_heap", "_limit", "_table", "earliest")

    def __init__(self, engine: Any, table: Table) -> None:
        self.earliest = inf
        """A time (seconds) before which no entry is due."""
        self._heap: list[Entry] = []
        self._count = 0
        self._limit = 256
        self._engine = engine
        self._table = table

    def add(self, time: float, kind: Kind, owner: Any) -> None:
        """Add an entry that is due at a time (seconds)."""
        self._count += 1
        if time < self.earliest:
            self.earliest = time
        heapq.heappush(self._heap, (time, kind, self._count, owner))
        if len(self._heap) > self._limit:  # remove stale entries before there are many
            self._heap = [entry for entry in self._heap if self._stands(entry)]
            heapq.heapify(self._heap)
            self._limit = max(256, 2 * len(self._heap))

    def next(self) -> float | None:
        """Return the time of the first valid entry (seconds); None if there is no valid entry."""
        heap, table, engine = self._heap, self._table, self._engine
        while heap and not table[heap[0][1]][0](engine, heap[0][0], heap[0][3]):
            heapq.heappop(heap)
        self.earliest = heap[0][0] if heap else inf
        return self.earliest if heap else None

    def pop(self, now: float) -> Entry | None:
        """Remove the first valid entry, and return it, if it is due at `now` (seconds); else return None."""
        due = self.next()
        return heapq.heappop(self._heap) if due is not None and due <= now else None

    def fall_due(self, entry: Entry) -> None:
        """Do what an entry is for."""
        self._table[entry[1]][1](self._engine, entry[0], entry[3])

    def _stands(self, entry: Entry) -> bool:
        return self._table[entry[1]][0](self._engine, entry[0], entry[3])

    def __len__(self) -> int:
        return len(self._heap)
