"""Slots that are bound to memory: writing the slot also writes the graph."""

from __future__ import annotations

import ravestate as rs
from ravestate.errors import DeclarationError, PlatformError

from .names import memory
from .names import module as ontology
from .node import Node


def bound(module: rs.Module, name: str, type: str) -> rs.Slot[Node | None]:
    """Declare and return a slot for a node. Each node that a rule writes to the slot is also saved in memory.

    The module gets the slot and a background rule ``remember_<name>``. The rule saves all nodes, in the order of the
    writes. If a write fails, or there is no memory, this is an error of that rule (``rs.error``). Writing None
    leaves memory unchanged.

    Args:
        module: The slot's module, which must require `ontology`.
        name: The slot's name.
        type: The type of the slot's nodes; subtypes are allowed.

    Raises:
        DeclarationError: The module does not require `ontology`, or the name is invalid.

    Example:
        ::

            host = rs.Module("host", requires=[ontology])
            guest = ontology.bound(host, "guest", "Person")

            @host.rule(when=introduced, writes=guest)
            async def meet(ctx):
                ctx[guest] = Node("Person", {"name": ctx.payload(introduced)})
    """
    if ontology not in module.requires:
        raise DeclarationError(
            f"module {module.name} ({module.origin}) binds {name} to memory but does not require ontology: write "
            f"rs.Module({module.name!r}, requires=[ontology, ...])"
        )
    slot: rs.Slot[Node | None] = module.slot(name, type=Node)

    @module.rule(
        when=slot.changed.max_age(None).detached(),
        reads=memory,
        background=True,
        name=f"remember_{name}",
    )
    async def remember(ctx: rs.RuleContext) -> None:
        """Save the slot's new node in memory."""
        node: Node | None = ctx.payload(slot.changed)
        if node is None:
            return
        opened = ctx[memory]
        if opened is None:
            raise PlatformError(f"{node.id} is not remembered: there is no memory, see the earlier warning")
        await opened.save(node, of=type)

    return slot
