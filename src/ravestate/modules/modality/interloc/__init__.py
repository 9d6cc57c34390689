"""The names of the users who are present, and of the agent."""

from __future__ import annotations

from .names import agent, facts, forgotten, module, users

__all__ = ["agent", "facts", "forgotten", "module", "users"]
