"""The module verbaliser: its settings and slots."""

from __future__ import annotations

from pathlib import Path

import ravestate as rs
from ravestate.modules import rawio

from .intents import Intent


class Settings(rs.Settings):
    """The language of the agent, and your own files of phrases."""

    language: str = "en"
    """The agent's language, e.g. ``de`` or ``de-AT``. If an intent (a meaning to express) has no phrases in
    ``de-AT``, the agent says it in ``de``, or else in English."""
    phrases: tuple[Path, ...] = ()
    """Your own files of phrases. They replace the modules' phrases, or add to them."""


module = rs.Module("verbaliser", requires=[rawio], settings=Settings)

intent: rs.Slot[str | Intent | None] = module.slot("intent", None, type=str | Intent, always=True)
"""The meaning to express now: the name of an intent, or an `Intent` with parameters."""

last: rs.Collection[str] = module.collection("last")
"""Name of an intent → the phrase (with its parameters in braces) that was used for it last."""
