"""The module interloc: its slot and its collection."""

from __future__ import annotations

from typing import Any

import ravestate as rs

module = rs.Module("interloc")

agent: rs.Slot[str] = module.slot("agent", "Ravestate", type=str, input=True)
"""The agent's name. `agentqa` writes it, from the agent's life file."""

users: rs.Collection[Any] = module.collection("users", input=True)
"""The present users: a key that the platform chooses for the user → the user's name, or None while it is unknown."""

facts: rs.Collection[tuple[str, ...]] = module.collection("facts", input=True)
"""Topic, such as ``home`` or ``sister`` → known facts about the user. A module that learns facts writes them."""

forgotten: rs.Signal[None] = module.signal("forgotten", input=True)
"""The user has been forgotten, so modules delete their data about the user. `persqa` raises it."""
