"""Small talk by a language model, where no other module has an answer."""

from __future__ import annotations

from . import rules as rules
from .backend import Backend, Message
from .names import Settings, history, model, module, trouble

__all__ = ["Backend", "Message", "Settings", "history", "model", "module", "trouble"]
