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
    names = {clause: _pathway_names(clause) for rule in writers for clause in rule.clauses}
    of_rule = {rule.index: frozenset[str]().union(*(names[c] for c in rule.clauses)) for rule in writers}
    found: list[Conflict] = []
    for position, first in enumerate(writers):
        for second in writers[position + 1 :]:
            slots = first.slotset & second.slotset
            causes = of_rule[first.index] & of_rule[second.index] if slots else frozenset[str]()
            if causes:
                a, b = (_best(rule, causes, names) for rule in (first, second))
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


def _best(rule: RulePlan, causes: frozenset[str], names: dict[Clause, frozenset[str]]) -> Clause:
    """The best of the clauses that share one of the causes."""
    return max((c for c in rule.clauses if names[c] & causes), key=lambda clause: clause.base)


def _pathway_names(clause: Clause) -> frozenset[str]:
    """The signals through which a clause can share a causal group: those of its non-detached needs' pathways."""
    if not clause.firm_bits:
        return frozenset()
    looked_at = {need.signal.name for need in clause.needs if need.detached}
    taken = {need.signal.name for need in clause.needs if not need.detached}
    return frozenset(
        signal.name
        for pathway in clause.pathways
        for signal in pathway
        if signal.name not in looked_at or signal.name in taken
    )
