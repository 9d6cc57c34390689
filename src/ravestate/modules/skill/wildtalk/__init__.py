"""Small talk when no other module has an answer: by a language model, or by the listening skill."""

from __future__ import annotations

from ravestate.language.chat import Backend, Message

from . import rules as rules
from .names import Settings, chosen, clock, history, listening, model, module, notes, overheard, trouble

__all__ = [
    "Backend",
    "Message",
    "Settings",
    "chosen",
    "clock",
    "history",
    "listening",
    "model",
    "module",
    "notes",
    "overheard",
    "trouble",
]
