"""The names of the users who are present, and of the agent."""

from __future__ import annotations

from .names import agent, module, users

__all__ = ["agent", "module", "users"]
