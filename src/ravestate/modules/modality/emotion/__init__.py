"""The agent's feelings: shy, surprised, happy, affectionate, sad. They are spontaneous, or fit the user's words."""

from __future__ import annotations

from . import rules
from .feeling import Feeling
from .names import Settings, affectionate, felt, happy, module, sad, shy, surprised
from .recogniser import recognise

__all__ = [
    "Feeling",
    "Settings",
    "affectionate",
    "felt",
    "happy",
    "module",
    "recognise",
    "rules",
    "sad",
    "shy",
    "surprised",
]
