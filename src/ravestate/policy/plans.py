"""The plans: modules in numbered form, which the engine and the analyses of a policy read."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from types import MappingProxyType
from typing import Any

from ravestate.declare.module import Module
from ravestate.declare.rule import Rule
from ravestate.declare.signal import Signal
from ravestate.declare.slot import Slot
from ravestate.declare.wording import few
from ravestate.errors import DeclarationError, DeclarationErrors
from ravestate.policy.causes import Causes
from ravestate.policy.completion import UNIT, Completion
from ravestate.policy.connect import connect, find_conflict_sets, find_halves, find_kin, find_unrivalled
from ravestate.policy.least import Least
from ravestate.policy.model import Clause, RulePlan, SignalPlan
from ravestate.policy.names import Names
from ravestate.policy.numbers import Numbers
from ravestate.policy.pathways import Pathways
from ravestate.policy.rules import Rules


class Plans:
    """The numbered signals, slots, rules and clauses of modules, with their utilities.

    Args:
        modules: The modules, each after those that it requires.
        declared: The rules: those of the modules, and those that a context has added.
        settings: The settings by module name. A module without an entry has its default settings.
        faults: Faults that the caller found.

    Raises:
        DeclarationErrors: There are faults. The exception holds the caller's faults and the faults found here.
    """

    def __init__(
        self,
        modules: Sequence[Module],
        declared: Sequence[Rule[Any, Any]],
        settings: Mapping[str, Any],
        faults: Sequence[str] = (),
    ) -> None:
        found = list(faults)
        names = Names(modules, found)
        numbers = Numbers(modules, settings, found)
        numbered = Rules(names, numbers, found)
        for rule in declared:
            numbered.add(rule)
        signals, rules = names.signals, numbered.plans
        connect(signals, names.slots, rules)
        causes = Causes(signals, rules)
        _check_reachable(causes, found)
        if found:
            raise DeclarationErrors([DeclarationError(fault) for fault in found])
        find_kin(rules, causes)
        completion = _assign_utilities(signals, rules, causes)
        find_unrivalled(rules)
        find_conflict_sets(signals, causes)
        find_halves(signals, causes)

        self.spare: list[Any] = []
        """Parts of engines (``engine/parts.py``) that no engine uses at present."""
        self.modules = tuple(modules)
        self.declared = tuple(declared)
        self.settings = settings
        self.refers = numbers.refers
        """Whether a declaration uses a setting."""
        self.signal_plans = tuple(signals)
        self.slot_plans = tuple(names.slots)
        self.rule_plans = tuple(rules)
        self.causes = causes
        self.pathways = Pathways(completion)
        clauses = [clause for rule in self.rule_plans for clause in (*rule.clauses, *rule.until)]
        self.clause_plans = {clause.index: clause for clause in clauses}
        self.plan_of = {plan.name: plan for plan in self.rule_plans}
        self.signal_of = {plan.name: plan for plan in self.signal_plans}
        self.slot_of = {plan.name: plan for plan in self.slot_plans}
        self.rules: Mapping[str, Rule[Any, Any]] = MappingProxyType({rule.name: rule for rule in self.declared})
        self.signals: Mapping[str, Signal[Any]] = MappingProxyType({p.name: p.signal for p in self.signal_plans})
        self.slots: Mapping[str, Slot[Any]] = MappingProxyType({p.name: p.slot for p in self.slot_plans})


def _check_reachable(causes: Causes, faults: list[str]) -> None:
    """Add a fault for each rule that no input can start.

    Each clause of such a rule waits for rules that cannot start either.

    A rule that lacks only the signal of a slot, or a detached effect, gets a finding instead. Code outside the rules
    may write slots, and detached effects make loops on purpose.
    """
    given = {s.index for s in causes.signals if s.input or s.slot is not None}
    given |= {signal for rule in causes.rules if rule.detached for signal in rule.raises}
    grounded = causes.grounded(given)
    for rule in causes.rules:
        if any(all(n.signal.index in grounded for n in clause.needs) for clause in rule.clauses):
            continue
        lacking = [n.signal for clause in rule.clauses for n in clause.needs if n.signal.index not in grounded]
        if not lacking:
            continue
        raisers = few(r.name for s in lacking for r in causes.all_causes[s.index])
        them = "it" if len({signal.index for signal in lacking}) == 1 else "them"
        faults.append(
            f"rule {rule.name} ({rule.rule.origin}) is unreachable: it waits for {few(s.name for s in lacking)}; no "
            f"input leads to the rules that may raise {them} ({raisers}); if code outside the rules raises the signal, "
            "declare it with input=True"
        )


PREDICATE = math.log(2)  # a ``where`` or ``holds`` predicate adds this many nats: it halves the probability (L9)
SAME = 1e-9  # base utilities count as equal if their relative difference is at most this
NO_INFORMATION = 1e-9  # the utility of a clause without information, in nats: above 0, so that its rule's weight counts


def _assign_utilities(signals: Sequence[SignalPlan], rules: Sequence[RulePlan], causes: Causes) -> Completion:
    """Set the utility, the base utility and the least pathway of every clause, and mark the cyclic clauses.

    Return the graph that completes clauses to pathways. From this graph, `Pathways` lists the clauses' other pathways.
    """
    completion = Completion(signals, rules, causes)
    least = Least(completion)
    of = causes.components.of
    for rule in rules:
        # A clause is cyclic if a signal that its rule raises leads to one of the clause's needs.
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
    _make_equal([clause for rule in rules for clause in rule.clauses])
    return completion


def _make_equal(clauses: Iterable[Clause]) -> None:
    """Make base utilities equal if they differ only in their last digits: such clauses count as equals (L15)."""
    last = 0.0
    for clause in sorted(clauses, key=lambda clause: clause.base):
        if clause.base - last <= SAME * clause.base:
            clause.base = last
        last = clause.base
