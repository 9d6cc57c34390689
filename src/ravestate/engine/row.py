"""A row: an index of the spikes that a half holds. With it, each clause of the half finds its spikes fast.

A *half* keeps the first spikes of clauses with two constraints (their *needs*), until the second spikes come
(``halves.py``).
"""

from __future__ import annotations

from collections import OrderedDict
from typing import TYPE_CHECKING

from ravestate.engine.spike import Spike
from ravestate.policy.model import Need

if TYPE_CHECKING:
    from ravestate.engine.state import State

SPARE = 32
"""The maximum size of a row is twice the number of spikes that its half holds, plus this number. A larger row drops the
spikes that the half gave up."""


class Row:
    """The spikes of a half, oldest first.

    A half may hold a spike for only some of its clauses. A spike that the half has given up for a clause does not come
    back. So the row notes, for each clause, how many spikes at the beginning of the row the clause can skip.
    """

    __slots__ = ("_held", "_last", "_spikes", "_starts")

    def __init__(self, held: OrderedDict[Spike, int]) -> None:
        self._held = held
        self._spikes: list[Spike] = []
        self._last = -1  # the number that `held` gives to the youngest spike in the row
        self._starts: dict[Need, int] = {}

    def find(self, need: Need, state: State, *, all_: bool) -> list[Spike]:
        """Return the spikes that the half holds for a need, oldest first; without `all_`, only the oldest."""
        self._catch_up()
        spikes, found = self._spikes, list[Spike]()
        place = self._starts.get(need, 0)
        while place < len(spikes) and not state.keeps(need, spikes[place]):
            place += 1
        self._starts[need] = place
        while place < len(spikes) and (all_ or not found):
            if state.keeps(need, spikes[place]):
                found.append(spikes[place])
            place += 1
        return found

    def _catch_up(self) -> None:
        """Add the half's new spikes to the row. If the row is too long, remove the spikes that the half gave up."""
        held = self._held
        new: list[Spike] = []
        for spike in reversed(held):
            if held[spike] <= self._last:
                break
            new.append(spike)
        if new:
            self._last = held[new[0]]
            self._spikes += reversed(new)
        if len(self._spikes) > 2 * len(held) + SPARE:
            left = [0]  # for each place: how many spikes before it are left
            for spike in self._spikes:
                left.append(left[-1] + (spike in held))
            self._starts = {need: left[start] for need, start in self._starts.items()}
            self._spikes = [spike for spike in self._spikes if spike in held]
