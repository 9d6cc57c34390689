"""Phrases for meanings: the agent expresses an intent, such as ``greet``, with a phrase from a file."""

from __future__ import annotations

from . import rules
from .intents import Intent
from .names import Settings, intent, last, module
from .phrases import PhraseBook

__all__ = ["Intent", "PhraseBook", "Settings", "intent", "last", "module", "rules"]
