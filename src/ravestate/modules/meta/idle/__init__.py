"""Notice awkward pauses: silence, and slow answers."""

from __future__ import annotations

from . import rules
from .names import Settings, asked, bored, dismissed, hushed, impatient, module, remarked, sorrow, unanswered

__all__ = [
    "Settings",
    "asked",
    "bored",
    "dismissed",
    "hushed",
    "impatient",
    "module",
    "remarked",
    "rules",
    "sorrow",
    "unanswered",
]
