"""Phrases for intents: the agent says an intent with a phrase from a file of phrases."""

from __future__ import annotations

from . import rules
from .intents import Intent
from .names import Settings, intent, last, module
from .phrases import PhraseBook

__all__ = ["Intent", "PhraseBook", "Settings", "intent", "last", "module", "rules"]
