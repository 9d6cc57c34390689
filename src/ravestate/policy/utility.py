"""Utility (L9): what a clause says about the situation, in nats, and what that makes of it in a contest."""

from __future__ import annotations

import math
from collections.abc import Sequence

from ravestate.policy.causes import Causes
from ravestate.policy.completion import UNIT, Completion
from ravestate.policy.least import Least
from ravestate.policy.pathways import Pathways
from ravestate.policy.plan import NO_INFORMATION, RulePlan, SignalPlan

__all__ = ["PREDICATE", "assign_utilities"]

PREDICATE = math.log(2)
"""Nats that a ``where`` or ``holds`` predicate adds: it halves the prior (L9)."""


def assign_utilities(signals: Sequence[SignalPlan], rules: Sequence[RulePlan], causes: Causes) -> None:
    """Give every clause its utility, its base and the way to its pathways, and mark cyclic clauses."""
    completion = Completion(signals, rules, causes)
    least = Least(completion)
    pathways = Pathways(completion)
    of = causes.components.of
    for rule in rules:
        # What a rule raises leads to what its clauses want: to raise what leads there too makes a cycle.
        raised = set[int]() if rule.detached else {of[signal] for signal in rule.raises}
        for clause in rule.clauses:
            firm = [need.signal.index for need in clause.needs if not need.detached]
            looked_at = [need.signal.index for need in clause.needs if need.detached]
            clause.cyclic = any(of[signal] in raised for signal in firm)
            predicates = len(clause.guards) + sum(len(need.predicates) for need in clause.needs)
            places = [completion.place[s] for s in firm]
            looked_places = [completion.place[s] for s in looked_at]
            cost, clause.least = least.pathway(places, looked_places)
            # Rounded, as predicates add what is no multiple of the unit.
            clause.utility = round(cost / UNIT + predicates * PREDICATE, 12)
            clause.base = (clause.utility or NO_INFORMATION) * rule.weight
            clause.completed = pathways
