"""The module verbaliser: its settings and slots."""

from __future__ import annotations

from pathlib import Path

import ravestate as rs
from ravestate.modules import rawio

from .intents import Intent

__all__ = ["Settings", "intent", "last", "module"]


class Settings(rs.Settings):
    """In which language an agent speaks, and with whose words."""

    language: str = "en"
    """As in ``de`` or ``de-AT``; an intent without phrases in it is worded in English."""
    phrases: tuple[Path, ...] = ()
    """Files of phrases of one's own, read after those of the modules; they replace their phrases, or add to them."""


module = rs.Module("verbaliser", requires=[rawio], settings=Settings)

intent: rs.Slot[str | Intent | None] = module.slot("intent", None, type=str | Intent, always=True)
"""What the agent means to say: the name of an intent, or an `Intent` with parameters. It is worded at once."""

last: rs.Collection[str] = module.collection("last")
"""For each intent the phrase that was chosen last, before its parameters were filled in."""
