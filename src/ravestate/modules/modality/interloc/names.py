"""The names of `interloc`: its module, its slot, its collections and its signals."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import ravestate as rs

if TYPE_CHECKING:
    from ravestate.modules.meta.ontology import Node

module = rs.Module("interloc")


class Recognised(str):
    """An item of `users`: the name of a user whom a platform or `visionio` has recognised.

    `node` is the user's node in memory.
    """

    node: Node

    def __new__(cls, name: str, node: Node) -> Recognised:
        """Return the name with the node."""
        self = super().__new__(cls, name)
        self.node = node
        return self


agent: rs.Slot[str] = module.slot("agent", "Ravestate", type=str, input=True)
"""The agent's name. `agentqa` writes it, from the file of facts about the agent."""

users: rs.Collection[Any] = module.collection("users", input=True)
"""The users who are present. The module that adds a user chooses the key. The item is the user's name, or None while
the name is unknown. If a platform or `visionio` has recognised the user, the name is a `Recognised`."""

recognised: rs.Signal[rs.Entry] = module.signal("recognised", payload=rs.Entry, input=True)
"""A platform or `visionio` has recognised a user who was already present. The payload is their entry in `users`."""

facts: rs.Collection[tuple[str, ...]] = module.collection("facts", input=True)
"""The known facts about the user: topic, such as ``home`` → values. A module that learns facts writes them."""

forgotten: rs.Signal[None] = module.signal("forgotten", input=True)
"""Memory has forgotten the user, so all modules delete their data about this user. `persqa` and the messengers raise
it."""
