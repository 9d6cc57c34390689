"""Generative small talk: when nothing more specific has an answer, a language model has one."""

from __future__ import annotations

from . import rules as rules
from .backend import Backend, Message
from .names import Settings, history, model, module, trouble

__all__ = ["Backend", "Message", "Settings", "history", "model", "module", "trouble"]
