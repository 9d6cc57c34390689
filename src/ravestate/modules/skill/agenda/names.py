"""The module, its settings, slots and signals."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

import ravestate as rs
from ravestate.modules import idle, rawio, verbaliser

from .state import GoalState
from .wish import Wish, without_twins


class Settings(rs.Settings):
    """When the agent may take the initiative, and goals that need no code."""

    gap: Annotated[float, Field(ge=0)] = 15.0
    """Seconds from the pursuit of one goal to the next."""
    goals: Annotated[tuple[Wish, ...], without_twins] = ()
    """Goals of your own: a name, and what to say."""


module = rs.Module("agenda", requires=[rawio, idle, verbaliser], settings=Settings)

opportunity = module.signal("opportunity", payload=float)
"""One goal may be pursued: neither side is talking, and the last goal is long enough ago. The payload is the time
(seconds)."""

goals: rs.Collection[GoalState] = module.collection("goals")
"""The state of each goal that was pursued, reached or dropped, by the name of its rule."""

topics: rs.Collection[str] = module.collection("topics", input=True)
"""The topics of the conversation. While there is one, no goal is pursued. A skill adds a name when it begins something,
and removes it at the end."""
