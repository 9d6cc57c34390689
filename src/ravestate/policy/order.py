"""The order of modules: core first, and each module after those that it requires; otherwise the user's order."""

from __future__ import annotations

from collections.abc import Iterable

from ravestate.declare.core import core
from ravestate.declare.module import Module


def in_order(given: Iterable[Module], faults: list[str]) -> list[Module]:
    """Return the given modules and all that they require, in order.

    Args:
        given: The modules in the user's order.
        faults: The list to which this function adds faults: cycles of `requires`, and names that two modules share.
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
