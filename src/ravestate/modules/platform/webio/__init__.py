"""A chat page on the web: each visitor has a conversation of their own with the agent."""

from __future__ import annotations

from . import rules as rules
from .names import Settings, module, page
from .serving import app, serve

__all__ = ["Settings", "app", "module", "page", "serve"]
