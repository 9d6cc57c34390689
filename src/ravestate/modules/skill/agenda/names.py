"""The names of `agenda`: its settings, its module, its collections and its signal."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Literal

from pydantic import Field

import ravestate as rs
from ravestate.modules import idle, rawio, verbaliser

from .wish import Wish, without_twins

Status = Literal["open", "pursued", "done", "dropped"]


@dataclass(frozen=True, slots=True)
class GoalState:
    """The state of a goal.

    Attributes:
        status: ``open`` until the goal is first pursued (the agent says its words), then ``pursued``; in the end ``done``
            or ``dropped``.
        tries: How many times the goal has been pursued.
        since: The time of the last try, in seconds since the context began.
    """

    status: Status = "open"
    tries: int = 0
    since: float = 0.0

    @property
    def is_over(self) -> bool:
        """Whether the goal is done or dropped."""
        return self.status in ("done", "dropped")


OPEN = GoalState()


class Settings(rs.Settings):
    """The settings of agenda: the time between pursuits, and goals that need no code."""

    gap: Annotated[float, Field(ge=0)] = 15.0
    """The minimum number of seconds from the pursuit of one goal to the pursuit of the next."""
    goals: Annotated[tuple[Wish, ...], without_twins] = ()
    """Goals of your own, each with a name and words; see `Wish`."""


module = rs.Module("agenda", requires=[rawio, idle, verbaliser], settings=Settings)

opportunity = module.signal("opportunity", payload=float)
"""The agent may pursue one goal: neither the agent nor the user is talking, the last pursuit is long enough ago, and the
conversation has no topic. The payload is the time on the context's clock (seconds)."""

goals: rs.Collection[GoalState] = module.collection("goals")
"""Name of a goal's rule → the goal's state, for each goal that was pursued, reached or dropped."""

topics: rs.Collection[str] = module.collection("topics", input=True)
"""Name of a skill → the topic that it talks about. While there is a topic, no goal is pursued. A skill adds a topic when
it begins to talk about something, and removes the topic at the end."""
