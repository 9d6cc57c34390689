"""Fillers: "Let me think…" when an answer takes its time."""

from __future__ import annotations

from . import rules as rules
from .names import Settings, filled, late, lost, module, promised

__all__ = ["Settings", "filled", "late", "lost", "module", "promised"]
