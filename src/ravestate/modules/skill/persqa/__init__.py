"""Small talk about the user: the agent asks about them, remembers the answers, and recognises them later."""

from __future__ import annotations

from . import rules as rules
from .names import Settings, facts, forgotten, module, noted, reply, talk, told, who
from .talk import Question, Talk
from .told import Told

__all__ = [
    "Question",
    "Settings",
    "Talk",
    "Told",
    "facts",
    "forgotten",
    "module",
    "noted",
    "reply",
    "talk",
    "told",
    "who",
]
