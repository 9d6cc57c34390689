"""A spike: an occurrence of a signal (L11)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ravestate.policy.model import SignalPlan

if TYPE_CHECKING:
    from ravestate.engine.activation import Activation
    from ravestate.engine.group import Group
    from ravestate.engine.loops import Lineage


class Spike:
    """An occurrence: payload, time of birth (seconds), parents, causal group, and holders.

    Attributes:
        before: The number of the last activation that is older than the spike.
        source: The number of the run that raised it; 0 from outside.
        holders: The activations that hold it, in the order of taking.
        claims: For each rule without slots: the activation that runs on the spike, or None after the run (L10).
        expiring: The times at which incomplete holders give it up for age (seconds).
        refused: The rules that gave it up for good.
        lineage: The rules that led to it, when an instant has many runs (L23).
    """

    __slots__ = (
        "before",
        "born",
        "claims",
        "expiring",
        "group",
        "holders",
        "id",
        "lineage",
        "parents",
        "payload",
        "refused",
        "rule",
        "signal",
        "source",
    )

    def __init__(
        self,
        id: int,
        signal: SignalPlan,
        payload: Any,
        born: float,
        group: Group,
        parents: tuple[Spike, ...],
        source: int,
        rule: int,
        before: int,
    ) -> None:
        self.id = id
        self.signal = signal
        self.payload = payload
        self.born = born
        self.group = group
        self.parents = parents
        self.source = source
        self.rule = rule  # index of the rule that raised it, -1 from outside
        self.before = before
        self.lineage: Lineage | None = None
        self.holders: dict[Activation, None] = {}
        self.expiring: tuple[float, ...] = ()
        self.refused: set[int] | None = None
        self.claims: dict[int, Activation | None] | None = None

    def refuse(self, rule: int) -> None:
        """Note that a rule gives the spike up for good."""
        if self.refused is None:
            self.refused = set()
        self.refused.add(rule)

    def descends_from(self, rule: int) -> bool:
        """Return whether a run of the rule is among its causes: cycles are cut there, so that loops end (L19)."""
        stack: list[Spike] = [self]
        seen: set[int] = set()
        while stack:
            spike = stack.pop()
            if spike.rule == rule:
                return True
            for parent in spike.parents:
                if parent.id not in seen:
                    seen.add(parent.id)
                    stack.append(parent)
        return False

    def comes_from(self, signal: str) -> bool:
        """Return whether it is a spike of the signal, or descends from one."""
        stack: list[Spike] = [self]
        seen: set[int] = set()
        while stack:
            spike = stack.pop()
            if spike.signal.name == signal:
                return True
            for parent in spike.parents:
                if parent.id not in seen:
                    seen.add(parent.id)
                    stack.append(parent)
        return False

    def __repr__(self) -> str:
        return f"{self.signal.name}#{self.id}"
