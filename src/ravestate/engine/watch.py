"""A watch over a run: the state of its `until` condition (law L21)."""

from __future__ import annotations

from ravestate.engine.activation import NEVER, Activation
from ravestate.engine.spike import Spike
from ravestate.policy.model import Clause


class Watch:
    """One clause of a run's `until` condition, and the spikes that meet its constraints so far.

    All these spikes were born after the run began.

    `due` is the time (seconds) at which all spikes will be old enough; `NEVER` while no such time is set.
    """

    __slots__ = ("clause", "due", "run", "spikes")

    def __init__(self, run: Activation, clause: Clause) -> None:
        self.run = run
        self.clause = clause
        self.due = NEVER
        self.spikes: list[Spike | None] = [None] * len(clause.needs)

    def met_at(self, now: float) -> float | None:
        """Return when the spikes meet the clause (seconds), or None while a spike is missing or too old."""
        due = now
        for need, spike in zip(self.clause.needs, self.spikes, strict=True):
            if spike is None or spike.born + need.max_age < now:
                return None
            due = max(due, spike.born + need.min_age)
        return due

    def lose(self, spike: Spike) -> None:
        """Give up a withdrawn spike (L20)."""
        self.spikes = [None if held is spike else held for held in self.spikes]
        self.due = NEVER
