"""Conflicts between rules (law L10): pairs of rules that exclude each other, and the winner of each pair."""

from __future__ import annotations

from dataclasses import dataclass

from ravestate.policy.completion import each
from ravestate.policy.model import Clause, RulePlan
from ravestate.policy.plans import Plans


@dataclass(frozen=True, slots=True)
class Conflict:
    """Two rules that exclude each other for a common cause.

    Attributes:
        first, second: The rules' names, in declaration order.
        slots: The names of the slots that both rules write.
        causes: The names of the signals that lie on pathways of both rules.
        winner: The name of the rule that goes first if both are ready, and neither is in its cooldown.
        margin: The winner's lead in utility x weight (nats). If both utilities are 0, the lead is 0, although the
            weights may decide which rule wins.
        tie: Whether only the order of declaration decides, because neither rule is ahead.
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
        """The names of both rules."""
        return (self.first, self.second)


def find_conflicts(policy: Plans) -> tuple[Conflict, ...]:
    """Return all conflicts, in the declaration order of their first rules, then of their second rules."""
    conflicts = Conflicts(policy)
    writing = writers(policy)
    found: list[Conflict | None] = []
    for first in policy.rule_plans:
        others = {r.index: r for slot in first.slots for r in writing[slot] if r.index > first.index}
        found += [conflicts.between(first, others[index]) for index in sorted(others)]
    return tuple(conflict for conflict in found if conflict is not None)


def writers(policy: Plans) -> dict[int, list[RulePlan]]:
    """Return a map from each slot's index to the rules that write the slot."""
    found: dict[int, list[RulePlan]] = {}
    for rule in policy.rule_plans:
        for slot in rule.slots:
            found.setdefault(slot, []).append(rule)
    return found


class Conflicts:
    """Finds the conflicts of one policy, pair by pair."""

    def __init__(self, policy: Plans) -> None:
        self.policy = policy
        self._roots: dict[Clause, int] = {}
        self._names: dict[int, tuple[str, ...]] = {}

    def roots(self, clause: Clause) -> int:
        """Return the roots of a clause's pathways, as bits: the signals or cycles where its causes begin
        (`Causes.roots`)."""
        found = self._roots.get(clause)
        if found is None:
            found = 0
            for need in clause.needs:
                if not need.detached:
                    found |= self.policy.causes.roots(need.signal.index)
            self._roots[clause] = found
        return found

    def best(self, first: RulePlan, second: RulePlan) -> tuple[Clause, Clause] | None:
        """For each rule, look at the clauses that share a root with the other rule, and return the one with the
        greatest base utility.

        If the rules do not conflict, return None instead of the pair.
        """
        if first.slotset.isdisjoint(second.slotset):
            return None
        common = self._of_rule(first) & self._of_rule(second)
        if not common:
            return None
        return self._best(first, common), self._best(second, common)

    def between(self, first: RulePlan, second: RulePlan) -> Conflict | None:
        """Return the conflict of two rules, given in declaration order; None if the rules do not conflict."""
        best = self.best(first, second)
        if best is None:
            return None
        a, b = best
        return Conflict(
            first.name,
            second.name,
            tuple(self.policy.slot_plans[s].name for s in sorted(first.slotset & second.slotset)),
            self._named(self._closure(first) & self._closure(second)),
            first.name if a.base >= b.base else second.name,
            round(abs(a.utility * first.weight - b.utility * second.weight), 12),
            a.base == b.base,
        )

    def _of_rule(self, rule: RulePlan) -> int:
        roots = 0
        for clause in rule.clauses:
            roots |= self.roots(clause)
        return roots

    def _best(self, rule: RulePlan, common: int) -> Clause:
        return max((c for c in rule.clauses if self.roots(c) & common), key=lambda clause: clause.base)

    def _closure(self, rule: RulePlan) -> int:
        closure = 0
        for clause in rule.clauses:
            for need in clause.needs:
                if not need.detached:
                    closure |= self.policy.causes.closure(need.signal.index)
        return closure

    def _named(self, signals: int) -> tuple[str, ...]:
        found = self._names.get(signals)
        if found is None:
            names = [self.policy.signal_plans[index].name for index in each(signals)]
            found = self._names[signals] = tuple(reversed(names))
        return found
