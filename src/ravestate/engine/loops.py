"""Endless loops (law L23): rules that trigger each other without time passing.

An instant lasts until the engine has nothing left to do. After `MANY` runs in one instant, the engine notes for each
new spike which rules led to the spike. A run is a further *turn* of a loop if an earlier run of the same rule led to
it. After `TURNS` turns of all loops together, the engine *defers* each further turn until nothing else is ready. When a
single loop has had `TURNS` turns, the engine names the loop's rules in an error.

The turns of all loops count together, because a rule that triggers two runs of itself soon makes thousands of loops.
The engine decides twice whether to defer an activation: when the activation becomes ready, and just before it starts.
Many turns may have run in between.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from operator import attrgetter
from typing import TYPE_CHECKING, Final

from ravestate.engine.activation import READY
from ravestate.engine.lineage import Lineage, Loop

if TYPE_CHECKING:
    from ravestate.engine.activation import Activation
    from ravestate.engine.memory import Memory
    from ravestate.policy.model import RulePlan

MANY: Final = 500
"""After this many runs in one instant, the engine notes which rules led to a spike. Most instants have fewer runs."""

TURNS: Final = 500
"""After this many turns in one instant, the engine defers further turns. `MANY` and `TURNS` add up to the 1,000 runs of
L23."""


class Loops:
    """The runs of the present instant, and the deferred turns of loops.

    `memory` keeps the rules that an error has named for a loop.

    Attributes:
        runs: How many runs there have been in this instant.
        late: How many deferred turns ran in this instant after an error had named their loop.
        deferred: The activations that wait until nothing else is ready, in the order in which they were deferred.
    """

    __slots__ = ("_instant", "_memory", "_next", "_turns", "deferred", "late", "runs")

    def __init__(self, memory: Memory) -> None:
        self._memory = memory
        self.runs = self.late = self._turns = 0
        self._next: Activation | None = None
        self.deferred: deque[Activation] | None = None  # made on first use: an empty one takes 600 bytes
        self._instant = 0

    @property
    def full(self) -> bool:
        """Whether further turns of loops wait until nothing else is ready."""
        return self._turns >= TURNS

    def rest(self) -> None:
        """End the instant, because nothing is left to do."""
        self.runs = self.late = self._turns = 0
        self._next = None
        self._instant += 1

    def defer(self, activation: Activation) -> bool:
        """Defer a ready activation if it is a further turn, and `TURNS` turns have run already. Return whether it is
        deferred."""
        if self._turns < TURNS or activation is self._next:
            return False
        rule = activation.clause.rule.index
        over = any(rule in line.rules for line in self._lines(activation))
        if over:
            if self.deferred is None:
                self.deferred = deque()
            self.deferred.append(activation)
        return over

    def next(self) -> Activation | None:
        """Remove the first deferred activation that is still ready, and return it; None if there is none."""
        while self.deferred:
            activation = self.deferred.popleft()
            if activation.state == READY:
                self.late += any(line.loop.turns >= TURNS for line in self._lines(activation))
                self._next = activation
                return activation
        return None

    def lineage(self, run: Activation) -> Lineage | None:
        """Return the lineage of the spikes that a run raises; None if the instant has few runs so far."""
        if run.lineage is None and self.runs > MANY:
            run.lineage = Lineage(frozenset((run.clause.rule.index,)), Loop(self._instant))
        return run.lineage

    def find(self, run: Activation) -> Sequence[RulePlan]:
        """Record the lineage of a run that starts. If an error must name its loop now, return the loop's rules; else
        return nothing."""
        lines = self._lines(run)
        if not lines:
            return ()  # `lineage` begins a loop if the run raises a spike
        rule, loop = run.clause.rule, max((line.loop for line in lines), key=attrgetter("turns"))
        rules = frozenset[int]().union(*(line.rules for line in lines))
        run.lineage = Lineage(rules | {rule.index}, loop)
        if rule.index not in rules:
            return ()
        self._turns += 1
        loop.turns += 1
        loop.rules[rule] = None
        new = loop.turns == TURNS and {one.index for one in loop.rules} - self._memory.looped
        if not new:
            return ()
        self._memory.looped |= new
        return sorted(loop.rules, key=attrgetter("index"))

    def _lines(self, activation: Activation) -> list[Lineage]:
        lines = [spike.lineage for spike in activation.spikes if spike is not None and spike.lineage is not None]
        return [line for line in lines if line.loop.instant == self._instant] if lines else lines
