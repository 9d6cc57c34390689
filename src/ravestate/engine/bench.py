"""A bench: first spikes of a clause that wait for the same second spike, their *counterpart*, or share it already.

A clause with two constraints takes two spikes. A *half* keeps the first spikes of such a clause, without activations
(``halves.py``). ``benches.py`` explains the use of benches.
"""

from __future__ import annotations

from collections import OrderedDict

from ravestate.engine.spike import Spike
from ravestate.policy.model import Half


class Bench:
    """Spikes that a half holds, and the one counterpart that they share.

    Attributes:
        half: The half.
        spikes: The spikes, oldest first. Each has a number *n*: if it gets activations, they are numbered from *n* + 1
            on.
        partner: The counterpart, or None if the spikes lack one.
        late: The spikes that became too old for the half while they had a counterpart.
    """

    __slots__ = ("half", "late", "partner", "spikes")

    def __init__(self, half: Half, spikes: OrderedDict[Spike, int]) -> None:
        self.half = half
        self.spikes = spikes
        self.partner: Spike | None = None
        self.late: list[Spike] = []

    def join(self, other: Bench) -> None:
        """Take over the spikes of another bench, and keep all of them in order of age."""
        mine, theirs = self.spikes, other.spikes
        if next(iter(theirs.values())) > next(reversed(mine.values())):
            mine.update(theirs)
        elif next(reversed(theirs.values())) < next(iter(mine.values())):
            for spike in reversed(theirs):
                mine[spike] = theirs[spike]
                mine.move_to_end(spike, last=False)
        else:
            both = sorted([*mine.items(), *theirs.items()], key=_number)
            mine.clear()
            mine.update(both)
        self.late += other.late


def _number(entry: tuple[Spike, int]) -> int:
    return entry[1]
