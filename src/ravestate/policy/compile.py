"""Compiling: modules become one immutable `Policy`, or one exception reports every fault (L6)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from types import ModuleType
from typing import Any

from ravestate.declare.module import Module, as_module
from ravestate.declare.rule import Rule
from ravestate.errors import DeclarationError, DeclarationErrors
from ravestate.policy.causes import Causes
from ravestate.policy.connect import connect, find_contests, find_kin
from ravestate.policy.names import Names
from ravestate.policy.numbers import Numbers
from ravestate.policy.order import in_order
from ravestate.policy.policy import Policy
from ravestate.policy.reachable import check_reachable
from ravestate.policy.rules import Rules
from ravestate.policy.utility import assign_utilities


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
    ordered = in_order(given, faults)
    rules = [rule for module in ordered for rule in module.rules]
    return build(tuple(ordered), rules, {}, faults)


def build(
    modules: Sequence[Module],
    rules: Sequence[Rule[Any, Any]],
    settings: Mapping[str, Any],
    faults: Sequence[str] = (),
) -> Policy:
    """Number all signals, slots and rules, and make the policy.

    Args:
        modules: All modules of the policy, in order.
        rules: All rules of the policy, in order. A rule that a context added is in none of the modules.
        settings: A module's name → its settings; a module that is missing here uses its default settings.
        faults: The faults that the caller has found already.

    Raises:
        DeclarationErrors: There is a fault, found here or by the caller.
    """
    found = list(faults)
    names = Names(modules, found)
    numbers = Numbers(modules, settings, found)
    numbered = Rules(names, numbers, found)
    for rule in rules:
        numbered.add(rule)
    connect(names.signals, names.slots, numbered.plans)
    causes = Causes(names.signals, numbered.plans)
    check_reachable(causes, found)
    if found:
        raise DeclarationErrors([DeclarationError(fault) for fault in found])
    find_kin(numbered.plans, causes)
    completion = assign_utilities(names.signals, numbered.plans, causes)
    find_contests(names.signals)
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
