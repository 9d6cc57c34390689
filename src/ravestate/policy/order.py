"""The order of modules: core first, then every module behind those that it requires; otherwise as given."""

from __future__ import annotations

from collections.abc import Iterable

from ravestate.declare.core import core
from ravestate.declare.module import Module
from ravestate.errors import DeclarationError

__all__ = ["in_order"]


def in_order(given: Iterable[Module], faults: list[DeclarationError]) -> list[Module]:
    """The given modules and all that they require, in order.

    Args:
        given: The modules that a user named.
        faults: Here cycles of `requires`, and names that two modules share, are put down.
    """
    ordered: dict[Module, None] = {core: None}
    names = {core.name: core}
    for wanted in given:
        way = {wanted: iter(wanted.requires)}  # each is required by the one before it
        while way:
            module, ahead = next(reversed(way.items()))
            required = next(ahead, None)
            if required is not None and required in way:
                members = list(way)
                cycle = [*members[members.index(required) :], required]
                faults.append(
                    DeclarationError(
                        f"modules require each other in a cycle: {' -> '.join(m.name for m in cycle)}; take one `requires` "
                        "out, or put what both need into a module of its own"
                    )
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
                        DeclarationError(
                            f"two modules are named {module.name!r}: {other.origin} and {module.origin}; rename one"
                        )
                    )
                ordered[module] = None
    return list(ordered)
