"""Conflicts between rules (L10): who excludes whom, and who wins."""

from __future__ import annotations

from dataclasses import dataclass

from ravestate.policy.plan import Clause, RulePlan
from ravestate.policy.policy import Policy

__all__ = ["Conflict", "find_conflicts"]


@dataclass(frozen=True, slots=True)
class Conflict:
    """Two rules that exclude each other for a cause that they share.

    Attributes:
        first, second: The rules' names, in declaration order.
        slots: The slots that both write.
        causes: The signals that lie on pathways of both.
        winner: The name of the rule that goes first when both are ready and recovered.
        margin: By how many nats of effective utility (utility x weight) it wins. 0 where neither carries
            information, even if a weight decides.
        tie: Whether only the order of declaration decides.
    """

    first: str
    second: str
    slots: tuple[str, ...]
    causes: tuple[str, ...]
    winner: str
    margin: float
    tie: bool

    @property
    def rules(self) -> tuple[str, str]:
        """Both names."""
        return (self.first, self.second)


def find_conflicts(policy: Policy) -> tuple[Conflict, ...]:
    """All conflicts, in declaration order of the first rule, then of the second."""
    writers = [rule for rule in policy.rule_plans if rule.slots]
    names = {rule.index: _pathway_names(rule) for rule in writers}
    found: list[Conflict] = []
    for position, first in enumerate(writers):
        for second in writers[position + 1 :]:
            slots = first.slotset & second.slotset
            causes = names[first.index] & names[second.index] if slots else frozenset[str]()
            if causes:
                a, b = _best(first), _best(second)
                found.append(
                    Conflict(
                        first.name,
                        second.name,
                        tuple(policy.slot_plans[s].name for s in sorted(slots)),
                        tuple(s for s in policy.signals if s in causes),
                        first.name if a.base >= b.base else second.name,
                        round(abs(a.utility * first.weight - b.utility * second.weight), 12),
                        a.base == b.base,
                    )
                )
    return tuple(found)


def _best(rule: RulePlan) -> Clause:
    return max(rule.clauses, key=lambda clause: clause.base)


def _pathway_names(rule: RulePlan) -> frozenset[str]:
    """The signals through which a rule can share a causal group: those of its non-detached needs' pathways."""
    return frozenset(
        signal.name
        for clause in rule.clauses
        if clause.firm_bits
        for pathway in clause.pathways
        for signal in pathway
        if not all(need.detached for need in clause.needs if need.signal.signal is signal)
        or not any(need.signal.signal is signal for need in clause.needs)
    )
