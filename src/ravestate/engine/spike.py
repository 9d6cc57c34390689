"""A spike: an occurrence of a signal (L11)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ravestate.policy.model import SignalPlan

if TYPE_CHECKING:
    from ravestate.engine.activation import Activation
    from ravestate.engine.group import Group
    from ravestate.engine.loops import Lineage

__all__ = ["Spike"]


class Spike:
    """Payload, time of birth (seconds), parents, causal group; and who holds it.

    Attributes:
        before: The number of the last activation that is older than the spike.
        source: The number of the run that raised it, 0 if it came from outside.
        holders: The activations that hold it, in the order in which they took it.
        claims: For rules without slots: the activation that runs on it, or None once one has (L10).
        expiring: The times at which holders that are still incomplete give it up for age (seconds).
        refused: Rules that gave it up for good.
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
        """The rule gives it up for good."""
        if self.refused is None:
            self.refused = set()
        self.refused.add(rule)

    def descends_from(self, rule: int) -> bool:
        """Whether a run of the rule is among its causes: cycles are cut there, so that loops end (L19)."""
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
        """Whether it is, or descends from, a spike of a signal."""
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
