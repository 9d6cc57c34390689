"""The names of the users who are present, and of the agent."""

from __future__ import annotations

from .names import Recognised, agent, facts, forgotten, module, recognised, users

__all__ = ["Recognised", "agent", "facts", "forgotten", "module", "recognised", "users"]
