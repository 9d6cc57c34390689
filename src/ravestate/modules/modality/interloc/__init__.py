"""The users that platforms see or hear, and the agent itself."""

from __future__ import annotations

from .names import agent, facts, module, users

__all__ = ["agent", "facts", "module", "users"]
