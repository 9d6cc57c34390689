"""A spike: an occurrence of a signal (L11)."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from ravestate.policy.model import SignalPlan

if TYPE_CHECKING:
    from ravestate.engine.activation import Activation
    from ravestate.engine.group import Group
    from ravestate.engine.loops import Lineage


@dataclass(slots=True, eq=False, repr=False)
class Spike:
    """An occurrence: payload, time of birth (seconds), parents, causal group, and holders.

    Attributes:
        rule: The number of the rule that raised it; -1 from outside, and for a detached rule.
        before: The number of the last activation that is older than the spike.
        source: The number of the run that raised it; 0 from outside.
        holders: The activations that hold it, in the order of taking.
        claims: For each rule without slots: the activation that runs on the spike, or None after the run (L10).
        expiring: The times at which incomplete holders give it up for age (seconds).
        refused: The rules that gave it up for good.
        lineage: In an instant with many runs: the rules that led to the spike (L23).
    """

    id: int
    signal: SignalPlan
    payload: Any
    born: float
    group: Group
    parents: tuple[Spike, ...]
    source: int
    rule: int
    before: int
    lineage: Lineage | None = field(init=False, default=None)
    holders: dict[Activation, None] = field(init=False, default_factory=dict[Any, None])
    expiring: tuple[float, ...] = field(init=False, default=())
    refused: set[int] | None = field(init=False, default=None)
    claims: dict[int, Activation | None] | None = field(init=False, default=None)

    def refuse(self, rule: int) -> None:
        """Note that a rule gives the spike up for good."""
        if self.refused is None:
            self.refused = set()
        self.refused.add(rule)

    def descends_from(self, rule: int) -> bool:
        """Return whether a run of the rule is among its causes: cycles are cut there, so that loops end (L19)."""
        return any(spike.rule == rule for spike in self._lineage())

    def comes_from(self, signal: str) -> bool:
        """Return whether it is a spike of the signal, or descends from one."""
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
