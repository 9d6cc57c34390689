"""Goals of the agent. The agent pursues a goal while the user is silent, until the goal is
reached or refused, or has no tries left."""

from __future__ import annotations

from . import rules as rules
from .goal import Goal, goal
from .names import GoalState, Settings, goals, module, opportunity, topics
from .wish import Wish

__all__ = ["Goal", "GoalState", "Settings", "Wish", "goal", "goals", "module", "opportunity", "topics"]
