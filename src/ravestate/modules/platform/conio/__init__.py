"""The console: the agent reads the lines that the user types, and prints its answers."""

from __future__ import annotations

from . import rules
from .console import Console
from .names import Settings, module, screen

__all__ = ["Console", "Settings", "module", "rules", "screen"]
