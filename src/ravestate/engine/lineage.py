"""The lineage of spikes and runs: the rules that led to them within an instant (law L23)."""

from __future__ import annotations

from typing import NamedTuple

from ravestate.policy.model import RulePlan


class Loop:
    """A run and all the runs that it has led to within an instant.

    Attributes:
        instant: The number of the instant.
        turns: How many of these runs were further *turns*: an earlier run of the same rule led to them (``loops.py``).
        rules: The rules of the runs that were further turns.
    """

    __slots__ = ("instant", "rules", "turns")

    def __init__(self, instant: int) -> None:
        self.instant = instant
        self.turns = 0
        self.rules: dict[RulePlan, None] = {}


class Lineage(NamedTuple):
    """The indices of the rules that led to a spike or run within an instant, and the `Loop` to which the spike or run
    belongs."""

    rules: frozenset[int]
    loop: Loop
