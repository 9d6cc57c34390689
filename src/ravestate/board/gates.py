"""The predicates on slots of a live policy, to be tried on values that slots had."""

from __future__ import annotations

from typing import Any

from ravestate.board.why_not import Opens
from ravestate.policy.policy import Policy

__all__ = ["gates_of"]


def gates_of(policy: Policy) -> Opens:
    """What tells, for a rule's clause and the number of a gate in it, whether a value of its slot opens it."""
    guards = {
        (rule.name, clause.number): clause.guards for rule in policy.rule_plans for clause in rule.clauses
    }

    def opens(rule: str, clause: int, number: int, value: Any) -> bool | None:
        found = guards.get((rule, clause), ())
        if number >= len(found):
            return None
        try:
            return bool(found[number][1].predicate(value))
        except Exception:  # the designer's code; one that fails counts as false
            return False

    return opens
