"""Compiling: modules become one immutable `Policy`, or one exception reports every fault (law L6)."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from types import ModuleType
from typing import Any

from ravestate.declare.core import core
from ravestate.declare.module import Module, as_module
from ravestate.declare.rule import Rule
from ravestate.declare.wording import few
from ravestate.errors import DeclarationError, DeclarationErrors
from ravestate.policy.causes import Causes
from ravestate.policy.completion import UNIT, Completion
from ravestate.policy.connect import connect, find_conflict_sets, find_halves, find_kin, find_unrivalled
from ravestate.policy.least import Least
from ravestate.policy.model import Clause, RulePlan, SignalPlan
from ravestate.policy.names import Names
from ravestate.policy.numbers import Numbers
from ravestate.policy.policy import Policy
from ravestate.policy.rules import Rules


def compile_policy(*modules: Module | ModuleType) -> Policy:
    """Compile modules, and the modules that they require, into a policy.

    Args:
        modules: `Module` values, or Python modules that hold one.

    Returns:
        The policy, which any number of contexts may share.

    Raises:
        DeclarationErrors: The modules have faults; the exception holds all of them.

    Example:
        >>> import ravestate as rs
        >>> hello = rs.Module("hello")
        >>> rs.compile(hello).rules
        mappingproxy({})
    """
    faults: list[str] = []
    given: list[Module] = []
    for value in modules:
        try:
            given.append(as_module(value))
        except DeclarationError as fault:
            faults.append(str(fault))
    ordered = _in_order(given, faults)
    rules = [rule for module in ordered for rule in module.rules]
    return build(tuple(ordered), rules, {}, faults)


def build(
    modules: Sequence[Module], rules: Sequence[Rule[Any, Any]], settings: Mapping[str, Any], faults: Sequence[str] = ()
) -> Policy:
    """Give numbers to all signals, slots and rules, and make the policy.

    A context may add rules that are in none of the modules. A module without an entry in `settings` has its default
    settings. Faults found here, and the caller's `faults`, are raised together.
    """
    found = list(faults)
    names = Names(modules, found)
    numbers = Numbers(modules, settings, found)
    numbered = Rules(names, numbers, found)
    for rule in rules:
        numbered.add(rule)
    connect(names.signals, names.slots, numbered.plans)
    causes = Causes(names.signals, numbered.plans)
    _check_reachable(causes, found)
    if found:
        raise DeclarationErrors([DeclarationError(fault) for fault in found])
    find_kin(numbered.plans, causes)
    completion = _assign_utilities(names.signals, numbered.plans, causes)
    find_unrivalled(numbered.plans)
    find_conflict_sets(names.signals, causes)
    find_halves(names.signals, causes)
    return Policy(
        modules=tuple(modules),
        declared=tuple(rules),
        signal_plans=tuple(names.signals),
        slot_plans=tuple(names.slots),
        rule_plans=tuple(numbered.plans),
        causes=causes,
        completion=completion,
        refers=numbers.refers,
        settings=settings,
    )


def _check_reachable(causes: Causes, faults: list[str]) -> None:
    """Add a fault for each rule that no input can start, because it waits for rules that cannot start either.

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


def _in_order(given: Iterable[Module], faults: list[str]) -> list[Module]:
    """Return the given modules and all that they require, each after the modules that it requires.

    Cycles of `requires`, and names that two modules share, go to `faults`.
    """
    ordered: dict[Module, None] = {core: None}
    names = {core.name: core}
    for wanted in given:
        way = {wanted: iter(wanted.requires)}  # a chain of modules, each of which requires the next
        while way:
            module, ahead = next(reversed(way.items()))
            required = next(ahead, None)
            if required is not None and required in way:
                members = list(way)
                cycle = [*members[members.index(required) :], required]
                faults.append(
                    f"modules require each other in a cycle: {' -> '.join(m.name for m in cycle)}; remove one `requires`, "
                    "or move the common names to a module of their own"
                )
            elif required is not None:
                if required not in ordered:
                    way[required] = iter(required.requires)
            else:
                del way[module]
                if module in ordered:
                    continue
                other = names.setdefault(module.name, module)
                if other is not module:
                    faults.append(
                        f"two modules are named {module.name!r}: {other.origin} and {module.origin}; rename one"
                    )
                ordered[module] = None
    return list(ordered)


PREDICATE = math.log(2)  # a ``where`` or ``holds`` predicate adds this many nats: it halves the probability (L9)
SAME = 1e-9  # base utilities count as equal if their relative difference is at most this
NO_INFORMATION = 1e-9  # the utility of a clause without information, in nats: above 0, so that its weight counts


def _assign_utilities(signals: Sequence[SignalPlan], rules: Sequence[RulePlan], causes: Causes) -> Completion:
    """Set the utility, the base utility and the least pathway of every clause, and mark the cyclic clauses.

    Return the graph in which clauses are completed. `Pathways` uses it to list the clauses' other pathways.
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
