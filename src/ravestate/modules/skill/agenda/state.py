"""The state of a goal."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

Status = Literal["open", "pursued", "done", "dropped"]


@dataclass(frozen=True, slots=True)
class GoalState:
    """The state of a goal.

    Attributes:
        status: ``open`` until the goal is first pursued, then ``pursued``; in the end ``done`` or ``dropped``.
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
