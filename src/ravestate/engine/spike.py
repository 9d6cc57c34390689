"""A spike: an occurrence of a signal (law L11)."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from ravestate.engine.group import NOTHING
from ravestate.policy.model import SignalPlan

if TYPE_CHECKING:
    from ravestate.engine.activation import Activation
    from ravestate.engine.group import Group
    from ravestate.engine.lineage import Lineage


class Spike:
    """An occurrence of a signal: payload, time of birth (seconds), parents, causal group, and holders.

    Attributes:
        rule: The index of the rule that raised the spike; -1 if code outside the rules or a detached rule raised it.
        before: The number of the youngest activation that is older than the spike.
        origin: The object that came from outside with the event that led to the spike, also through detached rules;
            None if there was no object.
        lineage: The rules that led to the spike within the instant of its birth; None if that instant had few runs
            (L23).
        holder: One of the activations that hold the spike, or None. Most spikes never have a second holder, and so need
            no table of holders.
        expiring: The times (seconds) at which holders that are not ready yet give the spike up, because of its age.
        in_halves: How many halves hold the spike, plus how many benches have it as their counterpart. A *half* keeps a
            spike without an activation, until a second spike comes, the *counterpart* (``halves.py``). On a *bench*,
            several spikes share one counterpart (``benches.py``).
        parted: The indices of the clauses for which these halves do not hold the spike. Such a clause gave the spike up
            or has retired, or an activation of the clause holds the spike.
        refused: The indices of the rules that gave the spike up for good.
    """

    __slots__ = (
        "_others",
        "before",
        "born",
        "in_halves",
        "expiring",
        "group",
        "holder",
        "id",
        "lineage",
        "origin",
        "parents",
        "parted",
        "payload",
        "refused",
        "rule",
        "signal",
    )

    def __init__(
        self,
        id: int,
        signal: SignalPlan,
        payload: Any,
        born: float,
        group: Group,
        parents: tuple[Spike, ...],
        rule: int,
        before: int,
    ) -> None:
        self.id = id
        self.signal = signal
        self.payload = payload
        self.born = born
        self.group = group
        self.parents = parents
        self.rule = rule
        self.before = before
        self.origin: Any = None
        self.lineage: Lineage | None = None
        self.holder: Activation | None = None
        self._others: dict[Activation, None] = NOTHING
        self.expiring: tuple[float, ...] = ()
        self.in_halves = 0
        self.parted: set[int] | None = None
        self.refused: set[int] | None = None

    @property
    def is_held(self) -> bool:
        """Whether an activation holds the spike."""
        return self.holder is not None or bool(self._others)

    @property
    def holders(self) -> tuple[Activation, ...]:
        """The activations that hold the spike, in the order in which they took it."""
        holder = self.holder
        if self._others:
            return tuple(self._others) if holder is None else (holder, *self._others)
        return () if holder is None else (holder,)

    def hold(self, holder: Activation) -> None:
        """Record that an activation holds the spike."""
        if self._others:
            if holder is not self.holder:
                self._others[holder] = None
        elif self.holder is None:
            self.holder = holder
        elif holder is not self.holder:
            self._others = {holder: None}

    def release(self, holder: Activation) -> bool:
        """Record that one of the holders gives the spike up; return whether another activation holds it."""
        if holder is self.holder:
            self.holder = None
            return bool(self._others)
        del self._others[holder]
        return self.is_held

    def refuse(self, rule: int) -> None:
        """Record that a rule gives the spike up for good."""
        if self.refused is None:
            self.refused = set()
        self.refused.add(rule)

    def descends_from(self, rule: int) -> bool:
        """Return whether a run of the rule is among the causes of the spike.

        If so, the rule may take the spike only for a detached need (L19).
        """
        return any(spike.rule == rule for spike in self._lineage())

    def comes_from(self, signal: str) -> bool:
        """Return whether this is a spike of the signal with this name, or descends from such a spike."""
        return any(spike.signal.name == signal for spike in self._lineage())

    def _lineage(self) -> Iterator[Spike]:
        """Yield the spike and all its ancestors, each once."""
        stack: list[Spike] = [self]
        seen: set[int] = set()
        while stack:
            spike = stack.pop()
            yield spike
            for parent in spike.parents:
                if parent.id not in seen:
                    seen.add(parent.id)
                    stack.append(parent)

    def __repr__(self) -> str:
        return f"{self.signal.name}#{self.id}"
