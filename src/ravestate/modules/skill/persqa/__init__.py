"""Small talk about the user: asks who he is, remembers it, and knows it when he comes back."""

from __future__ import annotations

from . import rules as rules
from .names import Settings, facts, module, reply, talk, who
from .talk import Question, Talk

__all__ = ["Question", "Settings", "Talk", "facts", "module", "reply", "talk", "who"]
