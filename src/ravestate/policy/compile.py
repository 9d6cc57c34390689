"""Compiling: modules become one immutable `Policy`, or one exception reports every fault (law L6)."""

from __future__ import annotations

from collections.abc import Iterable
from types import ModuleType

from ravestate.declare.core import core
from ravestate.declare.module import Module, as_module
from ravestate.errors import DeclarationError
from ravestate.policy.policy import Policy


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
    return Policy(ordered, rules, {}, faults)


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
