"""Utility (L9): the information of a clause about the situation, in nats."""

from __future__ import annotations

import math
from collections.abc import Sequence

from ravestate.policy.causes import Causes
from ravestate.policy.completion import UNIT, Completion
from ravestate.policy.least import Least
from ravestate.policy.model import RulePlan, SignalPlan

PREDICATE = math.log(2)  # the nats that a ``where`` or ``holds`` predicate adds: it halves the prior (L9)

NO_INFORMATION = 1e-9
"""The nats with which a clause without information (U = 0) competes, so that its weight and cooldown still count."""


def assign_utilities(signals: Sequence[SignalPlan], rules: Sequence[RulePlan], causes: Causes) -> Completion:
    """Set the utility, the base utility and the least pathway of every clause, and mark the cyclic clauses.

    Returns:
        The graph in which clauses are completed; `Pathways` lists their other pathways with it.
    """
    completion = Completion(signals, rules, causes)
    least = Least(completion)
    of = causes.components.of
    for rule in rules:
        # A clause is cyclic if a signal that its rule raises leads to one of its needs.
        raised = set[int]() if rule.detached else {of[signal] for signal in rule.raises}
        for clause in rule.clauses:
            firm = [need.signal.index for need in clause.needs if not need.detached]
            looked_at = [need.signal.index for need in clause.needs if need.detached]
            clause.cyclic = any(of[signal] in raised for signal in firm)
            predicates = len(clause.guards) + sum(len(need.predicates) for need in clause.needs)
            places = [completion.place[s] for s in firm]
            looked_places = [completion.place[s] for s in looked_at]
            cost, clause.least = least.pathway(places, looked_places)
            # The sum is rounded because the information of a predicate is not a multiple of the unit.
            clause.utility = round(cost / UNIT + predicates * PREDICATE, 12)
            clause.base = (clause.utility or NO_INFORMATION) * rule.weight
    return completion
