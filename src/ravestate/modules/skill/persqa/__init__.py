"""Small talk about the user: the agent asks about them, remembers the answers, and recognises them later."""

from __future__ import annotations

from . import publishing as publishing
from . import rules as rules
from .names import Settings, facts, module, reply, talk, who
from .talk import Question, Talk

__all__ = ["Question", "Settings", "Talk", "facts", "module", "reply", "talk", "who"]
