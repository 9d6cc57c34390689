"""Rules that trigger each other without time passing (L23).

In a loop, each rule has a clause whose signals come from rules of the loop, and at least one rule or constraint is
detached. Without detachment the causal group ends the loop (L19). A clause with a ``min_age``, a predicate or a gate
is not part of a loop here, because it may end one. Neither is a rule that awaits something, because it takes time.
"""

from __future__ import annotations

import dis
from collections.abc import Iterator
from types import CodeType

from ravestate.policy.components import components
from ravestate.policy.model import Clause, Need, RulePlan
from ravestate.policy.policy import Policy


def endless_loops(policy: Policy) -> Iterator[tuple[list[RulePlan], list[str]]]:
    """Yield each loop: its rules, and the names of the signals between them."""
    clauses = [
        clause
        for rule in policy.rule_plans
        for clause in rule.clauses
        if not (clause.guards or _takes_time(rule) or any(n.predicates or n.min_age for n in _wanted(clause)))
    ]
    while True:  # until the clauses that are left get all their signals from each other
        raised = {signal for clause in clauses for signal in _raised(policy, clause.rule)}
        left = [clause for clause in clauses if all(n.signal.index in raised for n in _wanted(clause))]
        if len(left) == len(clauses):
            break
        clauses = left
    wanted: dict[int, list[Need]] = {}
    for clause in clauses:
        for need in _wanted(clause):
            wanted.setdefault(need.signal.index, []).append(need)
    edges: list[dict[int, list[Need]]] = [{} for _ in policy.rule_plans]
    for rule in {clause.rule.index: clause.rule for clause in clauses}.values():
        for signal in _raised(policy, rule):
            for need in wanted.get(signal, ()):
                edges[rule.index].setdefault(need.clause.rule.index, []).append(need)
    found = components([tuple(ahead) for ahead in edges])
    for members in found.members:
        inner = [
            (policy.rule_plans[member], need)
            for member in sorted(members)
            for other, needs in edges[member].items()
            if other in members
            for need in needs
        ]
        if any(rule.detached or need.detached for rule, need in inner):
            names = dict.fromkeys(need.signal.name for _, need in inner)
            yield [policy.rule_plans[member] for member in sorted(members)], list(names)


def _wanted(clause: Clause) -> list[Need]:
    """Return the needs that take a new spike for each run; a detached need beside them may look at an old one."""
    return [need for need in clause.needs if not need.detached] or list(clause.needs)


def _raised(policy: Policy, rule: RulePlan) -> list[int]:
    """Return the signals of a rule that may start the next run at once."""
    changes = [policy.slot_plans[s].signals[0].index for s in rule.slots if not policy.slot_plans[s].is_flag]
    return [*rule.emits, *changes]


def _takes_time(rule: RulePlan) -> bool:
    code: CodeType | None = getattr(rule.rule.function, "__code__", None)
    return (
        code is None or "sleep" in code.co_names or any(i.opname == "GET_AWAITABLE" for i in dis.get_instructions(code))
    )
