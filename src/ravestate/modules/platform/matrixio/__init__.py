"""Matrix: each room of an account is a separate conversation with the agent."""

from __future__ import annotations

from . import rules as rules
from .names import Settings, chat, command, module
from .serving import serve

__all__ = ["Settings", "chat", "command", "module", "serve"]
