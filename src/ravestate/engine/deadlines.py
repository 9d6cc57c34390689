"""The deadlines, in one heap. An entry becomes stale when its owner (such as an activation or a spike) gets another
deadline, or no longer needs one.

`Deadlines` knows which entries are stale. ``parts.py`` has a table, `DUE`, of handlers for entries that are due.

A *clause* is one alternative of a rule's condition. A *need* is one constraint of a clause: it asks for one spike. A
*half* keeps a first spike, without an activation, until a second spike comes (``halves.py``). A detached need looks at
a spike without consuming it.
"""

from __future__ import annotations

import enum
import heapq
from math import inf
from typing import TYPE_CHECKING, Any

from ravestate.engine.activation import RUNNING

if TYPE_CHECKING:
    from ravestate.engine.state import State


class Kind(enum.IntEnum):
    """A kind of deadline. Deadlines at the same time are due in the order of these kinds.

    So an activation becomes ready before it could lose a spike.
    """

    RIPEN = 0  # all spikes of an activation are old enough
    LOOK = 1  # a spike is old enough for a detached need
    RECHECK = 2  # a reason to wait may end at this time (`Refusal.recheck`)
    PATIENCE = 3  # a rival's patience ends: others wait for it, and it lacks an input or an effect of another group
    EXPIRE = 4  # a spike is too old for an activation that is not ready, or for a half
    FORGET = 5  # a spike is too old for every detached need
    TIMEOUT = 6  # a run times out
    WATCH = 7  # the spikes of an `until` condition are old enough


# Reading a member from its enumeration takes longer than reading one of these names.
RIPEN, LOOK, RECHECK, PATIENCE, EXPIRE, FORGET, TIMEOUT, WATCH = Kind

Entry = tuple[float, Kind, int, Any]
"""A deadline: its time (seconds), its kind, its number in the order of `Deadlines.add`, and its owner: the object that
it concerns."""


class Deadlines:
    """A heap of the deadlines of one engine."""

    __slots__ = ("_count", "_heap", "_limit", "earliest", "state")

    def __init__(self, state: State) -> None:
        self.state = state
        self.earliest = inf
        """No entry is due before this time (seconds)."""
        self._heap: list[Entry] = []
        self._count = 0
        self._limit = 256

    def add(self, time: float, kind: Kind, owner: Any) -> None:
        """Add an entry that is due at a time (seconds)."""
        self._count += 1
        if time < self.earliest:
            self.earliest = time
        heapq.heappush(self._heap, (time, kind, self._count, owner))
        if len(self._heap) > self._limit:  # remove stale entries before there are many
            self._heap = [entry for entry in self._heap if self._counts(entry[0], entry[1], entry[3])]
            heapq.heapify(self._heap)
            self._limit = max(256, 2 * len(self._heap))

    def next(self) -> float | None:
        """Return the time, in seconds, of the first entry that is not stale; None if there is none."""
        heap = self._heap
        while heap:
            time, kind, _, owner = heap[0]
            if self._counts(time, kind, owner):
                self.earliest = time
                return time
            heapq.heappop(heap)
        self.earliest = inf
        return None

    def pop(self, now: float) -> Entry | None:
        """If the first entry that is not stale is due at `now` (seconds), remove and return it; else return None."""
        due = self.next()
        return heapq.heappop(self._heap) if due is not None and due <= now else None

    def _counts(self, time: float, kind: Kind, owner: Any) -> bool:
        """Return whether an entry is not stale."""
        if kind == RIPEN:
            return owner.ripens == time
        if kind == LOOK:
            return self.state.is_live(owner[1])
        if kind == RECHECK:
            return owner.refusal is not None and owner.refusal.recheck == time
        if kind == PATIENCE:
            group, rival = owner[0].root(), owner[1]
            return rival.state < RUNNING and rival.patience_ends.get(group) == time
        if kind == EXPIRE:
            return owner.is_held or self.state.is_live(owner)
        if kind == FORGET:
            return self.state.is_live(owner)
        if kind == TIMEOUT:
            return owner.deadline == time
        return owner.due == time and owner.run.state == RUNNING  # WATCH

    def __len__(self) -> int:
        return len(self._heap)
