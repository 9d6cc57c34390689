"""Loops without an end (L23): rules that set each other off without time passing.

An instant lasts until the engine has nothing left to do. After `MANY` runs in one instant the engine notes, for each
new spike, which rules led to it. A run whose own rule led to it is a further turn of a loop. After `TURNS` of them in
all, each further turn waits until nothing else is ready. A loop is named once it has had so many turns of its own.

A rule that sets off two runs of itself makes one loop into thousands. So the turns of all loops count together. A turn
is judged when it becomes ready, and again when it is to start: thousands may be ready by then.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from operator import attrgetter
from typing import TYPE_CHECKING, NamedTuple

from ravestate.engine.activation import READY

if TYPE_CHECKING:
    from ravestate.engine.activation import Activation
    from ravestate.policy.model import RulePlan

MANY = 500
"""Runs in one instant that are not traced; most instants have fewer, so tracing costs them nothing."""

TURNS = 500
"""Further turns in one instant that go ahead like any other run: with the runs before, 1,000."""


class Loop:
    """All that one run has set off within an instant.

    Attributes:
        instant: The number of the instant.
        turns: How many of the runs were further turns.
        rules: The rules of these runs.
    """

    __slots__ = ("instant", "rules", "turns")

    def __init__(self, instant: int) -> None:
        self.instant = instant
        self.turns = 0
        self.rules: dict[RulePlan, None] = {}


class Lineage(NamedTuple):
    """The rules (by number) that led to a spike within an instant, and the loop that it may belong to."""

    rules: frozenset[int]
    loop: Loop


class Loops:
    """The runs of the present instant, and the turns that wait.

    Attributes:
        runs: How many runs there have been in this instant.
        late: How many of them had been deferred as turns of a loop that has been named.
        deferred: The activations that wait until nothing else is ready, oldest first.
    """

    __slots__ = ("_instant", "_named", "_next", "_turns", "deferred", "late", "runs")

    def __init__(self) -> None:
        self.runs = self.late = self._turns = 0
        self._next: Activation | None = None
        self.deferred: deque[Activation] = deque()
        self._instant = 0
        self._named: set[int] = set()

    def rest(self) -> None:
        """End the instant: nothing is left to do."""
        self.runs = self.late = self._turns = 0
        self._next = None
        self._instant += 1

    def defer(self, activation: Activation) -> bool:
        """Put a ready activation off if it is one turn too many; return whether it is."""
        if self._turns < TURNS or activation is self._next:
            return False
        rule = activation.clause.rule.index
        over = any(rule in line.rules for line in self._lines(activation))
        if over:
            self.deferred.append(activation)
        return over

    def next(self) -> Activation | None:
        """Take the oldest deferred activation that is still ready."""
        while self.deferred:
            activation = self.deferred.popleft()
            if activation.state is READY:
                self.late += any(line.loop.turns >= TURNS for line in self._lines(activation))
                self._next = activation
                return activation
        return None

    def lineage(self, run: Activation) -> Lineage | None:
        """Return the rules that led to the next spike of a run; None unless the instant has many runs."""
        if run.lineage is None and self.runs > MANY:
            run.lineage = Lineage(frozenset((run.clause.rule.index,)), Loop(self._instant))
        return run.lineage

    def trace(self, run: Activation) -> Sequence[RulePlan]:
        """Note what led to a run; return the rules of its loop, in declaration order, when they are to be named."""
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
        new = loop.turns == TURNS and {one.index for one in loop.rules} - self._named
        if not new:
            return ()
        self._named |= new
        return sorted(loop.rules, key=attrgetter("index"))

    def _lines(self, activation: Activation) -> list[Lineage]:
        lines = [spike.lineage for spike in activation.spikes if spike is not None and spike.lineage is not None]
        return [line for line in lines if line.loop.instant == self._instant] if lines else lines
