"""What the agent wants: goals that it pursues when nothing else happens, and drops when they are reached."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

import ravestate as rs
from ravestate.modules import idle, rawio, verbaliser

from .state import GoalState
from .wish import Wish, without_twins


class Settings(rs.Settings):
    """When the agent may take the initiative, and goals of which only the words are told."""

    gap: Annotated[float, Field(ge=0)] = 15.0
    """Seconds from the pursuit of one goal to that of the next, however bored the agent is."""
    goals: Annotated[tuple[Wish, ...], without_twins] = ()
    """Goals of one's own: each with its name and what to say for it."""


module = rs.Module("agenda", requires=[rawio, idle, verbaliser], settings=Settings)

opportunity = module.signal("opportunity", payload=float)
"""Nobody is busy, and the last goal is long enough ago: one goal may be pursued. The payload is the time (seconds)."""

goals: rs.Collection[GoalState] = module.collection("goals")
"""How it stands with each goal that was pursued, reached or dropped, by the name of its rule."""

topics: rs.Collection[str] = module.collection("topics", input=True)
"""What the talk is about. While there is anything, no goal is pursued: a skill that begins something adds its name, and
removes it at the end."""
