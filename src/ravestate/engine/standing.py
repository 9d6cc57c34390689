"""Standing: the order of clauses by effective utility, now and later (laws L9, L15).

The effective utility of a clause is its utility x its rule's weight x its rule's recovery. After a run that *fired*
(consumed its spikes), recovery climbs from 0 to 1 over the rule's cooldown. If the effective utilities of two clauses
are 0, weight x recovery decides. If the clauses are still equal, the one declared first is ahead. A *crossing* is a
moment at which recovery changes the order of two clauses.
"""

from __future__ import annotations

from collections.abc import Mapping
from math import inf

from ravestate.policy.model import Clause

SAME = 1e-9
"""Two utilities count as equal if their relative difference is at most this, because times of crossings are rounded."""

DIGITS = 9
"""The time of a crossing (seconds) is rounded to this many decimal places, so that events of one moment coincide."""

INSTANT = 0.5e-9
"""Moments that differ by less than this (seconds) are the same: this is half a unit of the last decimal place
(`DIGITS`)."""


class Standing:
    """The effective utilities of clauses at an engine's present moment; `ran` is `Memory.ran`."""

    __slots__ = ("now", "ran")

    def __init__(self, ran: Mapping[int, float]) -> None:
        self.ran = ran
        self.now = 0.0

    def recovery(self, clause: Clause) -> tuple[float, float]:
        """Return how far the clause's rule has recovered (0 to 1), and how fast it recovers (per second)."""
        rule = clause.rule
        if rule.cooldown:
            ran = self.ran.get(rule.index)
            if ran is not None and self.now - ran < rule.cooldown - INSTANT:
                return (self.now - ran) / rule.cooldown, 1.0 / rule.cooldown
        return 1.0, 0.0

    def effective(self, clause: Clause) -> float:
        """Return the effective utility of a clause now, in nats (L9)."""
        return clause.base * self.recovery(clause)[0] if clause.rule.cooldown else clause.base

    def lead(self, one: Clause, other: Clause) -> float:
        """Return by how many nats `one` is ahead of `other` now.

        The result is 0 if `one` is not ahead, or if only weights or the order of declaration decide.
        """
        worth = one.utility * one.rule.weight * self.recovery(one)[0]
        return max(0.0, lead(worth, other.utility * other.rule.weight * self.recovery(other)[0]))

    def is_ahead(self, one: Clause, other: Clause) -> bool:
        """Return whether `one` is ahead of `other`, both now and in the next moment. If so, `other` waits for `one`."""
        if not (one.rule.cooldown or other.rule.cooldown):
            return one.base > other.base or (one.base == other.base and one.index < other.index)
        now, soon = self._leads(one, other)
        return now and soon

    def overtakes(self, one: Clause, other: Clause) -> bool:
        """Return whether `one` is ahead of `other` in the next moment. If so, `other` then waits for `one` (L16)."""
        if not (one.rule.cooldown or other.rule.cooldown):
            return self.is_ahead(one, other)
        return self._leads(one, other)[1]

    def _leads(self, one: Clause, other: Clause) -> tuple[bool, bool]:
        """Return whether `one` is ahead of `other` now, and whether it is in the next moment."""
        (far, fast), (their_far, their_fast) = self.recovery(one), self.recovery(other)
        worth = (one.utility * one.rule.weight, other.utility * other.rule.weight)
        weight = (one.rule.weight, other.rule.weight)
        now = (worth[0] * far, worth[1] * their_far)
        trend = (worth[0] * fast, worth[1] * their_fast)
        bare = (weight[0] * far, weight[1] * their_far)
        ahead = lead(*now)
        soon = ahead or lead(*trend)
        if now == (0.0, 0.0):
            ahead = lead(*bare)
            if trend == (0.0, 0.0):
                soon = ahead or lead(weight[0] * fast, weight[1] * their_fast)
        first = 1 if one.index < other.index else -1
        return (ahead or first) > 0, (soon or first) > 0

    def crossing(self, one: Clause, other: Clause) -> float:
        """Return the time (seconds) at which recovery next may change the order of two clauses; `inf` for never.

        The result depends on the times of the last runs, not on the present time. So all activations that wait for the
        crossing get exactly the same time.
        """
        (far, fast), (their_far, their_fast) = self.recovery(one), self.recovery(other)
        closing = one.base * fast - other.base * their_fast
        turn = inf
        if closing * (other.base * their_far - one.base * far) > 0:
            began = max(self.ran[c.rule.index] for c, speed in ((one, fast), (other, their_fast)) if speed)
            far = (began - self.ran[one.rule.index]) * fast if fast else far
            their_far = (began - self.ran[other.rule.index]) * their_fast if their_fast else their_far
            turn = began + (other.base * their_far - one.base * far) / closing
        for clause in (one, other):
            ran = self.ran.get(clause.rule.index)
            if ran is not None and self.now < ran + clause.rule.cooldown < turn:
                turn = ran + clause.rule.cooldown
        rounded = round(turn, DIGITS)
        return rounded if rounded > self.now else turn if turn > self.now else inf


def lead(one: float, other: float) -> float:
    """Return by how much a utility or weight exceeds another, negative if it is smaller; 0 if they count as equal."""
    return 0.0 if abs(one - other) <= SAME * max(abs(one), abs(other)) else one - other
