"""Endless loops (L23): rules that trigger each other without time passing.

An instant lasts until the engine has nothing left to do. After `MANY` runs in one instant the engine notes, for each
new spike, which rules led to it. If a run's own rule led to it, the run is another turn of a loop. After `TURNS` turns,
each further turn waits until nothing else is ready.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

from ravestate.engine.activation import READY

if TYPE_CHECKING:
    from ravestate.engine.activation import Activation
    from ravestate.policy.model import RulePlan

MANY = 500
"""Runs in one instant that are not traced; most instants have fewer, so tracing costs them nothing."""

TURNS = 500
"""Turns of a loop that start like any other run; together with the runs before them, 1,000."""


class Loop:
    """All runs that one run has triggered within an instant.

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
        late: How many of them had been deferred.
        deferred: The activations that wait until nothing else is ready, oldest first.
    """

    __slots__ = ("_instant", "_named", "deferred", "late", "runs")

    def __init__(self) -> None:
        self.runs = self.late = 0
        self.deferred: deque[Activation] = deque()
        self._instant = 0
        self._named: set[int] = set()

    def rest(self) -> None:
        """End the instant: nothing is left to do."""
        self.runs = self.late = 0
        self._instant += 1

    def defer(self, activation: Activation) -> bool:
        """Defer a ready activation if it is one turn too many; return whether it is."""
        rule = activation.clause.rule.index
        over = any(rule in line.rules and line.loop.turns >= TURNS for line in self._lines(activation))
        if over:
            self.deferred.append(activation)
        return over

    def next(self) -> Activation | None:
        """Take the oldest deferred activation that is still ready."""
        while self.deferred:
            activation = self.deferred.popleft()
            if activation.state is READY:
                self.late += 1
                return activation
        return None

    def trace(self, run: Activation) -> Sequence[RulePlan]:
        """Note what led to a run; return the rules of its loop, in declaration order, when they are to be named."""
        rule = run.clause.rule
        lines = self._lines(run)
        loop = max((line.loop for line in lines), key=_turns) if lines else Loop(self._instant)
        rules = frozenset[int]().union(*(line.rules for line in lines))
        run.lineage = Lineage(rules | {rule.index}, loop)
        if rule.index not in rules:
            return ()
        loop.turns += 1
        loop.rules[rule] = None
        new = loop.turns == TURNS and {one.index for one in loop.rules} - self._named
        if not new:
            return ()
        self._named |= new
        return sorted(loop.rules, key=_number)

    def _lines(self, activation: Activation) -> list[Lineage]:
        found = [spike.lineage for spike in activation.spikes if spike is not None]
        return [line for line in found if line is not None and line.loop.instant == self._instant]


def _turns(loop: Loop) -> int:
    return loop.turns


def _number(rule: RulePlan) -> int:
    return rule.index
