"""Intents to phrases: what is meant is worded from files of phrases."""

from __future__ import annotations

from pathlib import Path

import ravestate as rs
from ravestate.modules import rawio

from .intent import Intent
from .phrases import PhraseBook

__all__ = ["Intent", "PhraseBook", "Settings", "intent", "last", "module"]


class Settings(rs.Settings):
    """In which language an agent speaks, and with whose words."""

    language: str = "en"
    """As in ``de`` or ``de-AT``; an intent without phrases in it is worded in English."""
    files: tuple[Path, ...] = ()
    """YAML files of phrases, read after those of the modules: their phrases replace, or add to, the modules' own."""


module = rs.Module("verbaliser", requires=[rawio], settings=Settings)

intent: rs.Slot[Intent | str | None] = module.slot("intent", None, always=True)
"""What is to be said: an `Intent`, or the name of one that stands in the files of the settings."""

last: rs.Slot[dict[str, str]] = module.slot("last", {})
"""The phrase that was used last for each intent, so that it is not used twice running."""

from . import rules as rules  # noqa: E402  # they use what is declared above
