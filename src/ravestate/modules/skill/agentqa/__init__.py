"""Answers to questions about the agent: its name, origin, likes, mood."""

from __future__ import annotations

from . import rules as rules
from .life import Life, Topic
from .life_file import read_life
from .names import Settings, asked, clock, life, module, mood, prompted, remarked, turns
from .remarks import Remark
from .router import Match, Router

__all__ = [
    "Life",
    "Match",
    "Remark",
    "Router",
    "Settings",
    "Topic",
    "asked",
    "clock",
    "life",
    "module",
    "mood",
    "prompted",
    "read_life",
    "remarked",
    "turns",
]
