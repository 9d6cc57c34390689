"""Findings: what compiles, but is probably not meant."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from ravestate.policy.plan import Clause, RulePlan
from ravestate.policy.policy import Policy

__all__ = ["Finding", "find_all"]


@dataclass(frozen=True, slots=True)
class Finding:
    """One remark on a policy.

    Attributes:
        kind: ``"unreachable"``, ``"never-wins"``, ``"tie"`` or ``"unheard"``.
        subject: The qualified name of the rule or signal.
        message: What is the matter, and what to write instead.
    """

    kind: str
    subject: str
    message: str

    def __str__(self) -> str:
        return f"{self.kind}: {self.message}"


def find_all(policy: Policy) -> tuple[Finding, ...]:
    """All findings: unreachable rules first, then rules that never win, ties, unheard signals."""
    return (*_unreachable(policy), *_never_wins(policy), *_ties(policy), *_unheard(policy))


def _unreachable(policy: Policy) -> Iterator[Finding]:
    grounded = policy.causes.grounded(s.index for s in policy.signal_plans if s.input)
    for rule in policy.rule_plans:
        lacking = [n.signal for c in rule.clauses for n in c.needs if n.signal.index not in grounded]
        if not any(all(n.signal.index in grounded for n in c.needs) for c in rule.clauses):
            names = ", ".join(dict.fromkeys(s.name for s in lacking))
            yield Finding(
                "unreachable",
                rule.name,
                f"rule {rule.name} runs only if {names} comes from outside: nothing leads there from an input; declare "
                "it with input=True if it does",
            )
        elif rule.slots and all(_starves(policy, clause) for clause in rule.clauses):
            slots = ", ".join(policy.slot_plans[s].name for s in rule.slots)
            yield Finding(
                "unreachable",
                rule.name,
                f"rule {rule.name} waits for an effect of rules that write {slots} before it, and in one causal group a "
                "slot is written once (L19): write .detached() behind that signal, or detached=True at the rule "
                "that causes it",
            )


def _starves(policy: Policy, clause: Clause) -> bool:
    """Whether one of the clause's signals comes only from rules that take a slot the clause writes."""
    for need in clause.needs:
        raisers = policy.causes.all_causes[need.signal.index]
        if (
            not need.detached
            and not need.signal.input
            and raisers
            and all(not r.detached and not r.slotset.isdisjoint(clause.rule.slotset) for r in raisers)
        ):
            return True
    return False


def _never_wins(policy: Policy) -> Iterator[Finding]:
    writers: dict[int, list[Clause]] = {}
    for rule in policy.rule_plans:
        for slot in rule.slots:
            writers.setdefault(slot, []).extend(rule.clauses)
    for rule in policy.rule_plans:
        if not rule.slots or not rule.clauses:
            continue
        losers = [
            next((w for s in rule.slots for w in writers[s] if _dominates(w, c)), None) for c in rule.clauses
        ]
        if all(losers):
            names = ", ".join(dict.fromkeys(w.rule.name for w in losers if w is not None))
            yield Finding(
                "never-wins",
                rule.name,
                f"rule {rule.name} runs only when {names} resigns: whatever triggers it triggers that as well, and it "
                "has no greater utility; give it a further signal, a weight, or the other a cooldown",
            )


def _dominates(winner: Clause, loser: Clause) -> bool:
    """Whether `winner` is ready whenever `loser` is, and goes first."""
    if winner.rule is loser.rule or winner.rule.cooldown or winner.guards:
        return False
    if (-winner.base, winner.index) > (-loser.base, loser.index):
        return False
    if not winner.firm_bits or any(n.detached or n.predicates for n in winner.needs):
        return False
    return all(
        any(
            not theirs.detached
            and theirs.signal is mine.signal
            and theirs.min_age >= mine.min_age
            and theirs.max_age <= mine.max_age
            for theirs in loser.needs
        )
        for mine in winner.needs
    )


def _ties(policy: Policy) -> Iterator[Finding]:
    for conflict in policy.conflicts():
        if conflict.tie and not _apart(policy.rule_plan(conflict.first), policy.rule_plan(conflict.second)):
            yield Finding(
                "tie",
                conflict.second,
                f"rules {conflict.first} and {conflict.second} have the same utility for {', '.join(conflict.slots)}: "
                f"{conflict.winner} goes first because it is declared first; a weight would say so",
            )


def _apart(first: RulePlan, second: RulePlan) -> bool:
    """Whether payloads tell the rules apart: both ask for different ones of the same signal."""
    mine = {need.signal.index: need.predicates for clause in first.clauses for need in clause.needs}
    theirs = {need.signal.index: need.predicates for clause in second.clauses for need in clause.needs}
    return any(mine[s] and theirs[s] and mine[s] != theirs[s] for s in mine.keys() & theirs.keys())


def _unheard(policy: Policy) -> Iterator[Finding]:
    for signal in policy.signal_plans:
        if (
            signal.slot is None
            and not signal.listeners
            and not signal.watchers
            and not signal.name.startswith("core:")
        ):
            raisers = policy.causes.all_causes[signal.index]
            if raisers:
                yield Finding(
                    "unheard",
                    signal.name,
                    f"signal {signal.name} is raised by {', '.join(r.name for r in raisers)}, and no rule hears it",
                )
