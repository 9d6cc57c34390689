"""The module verbaliser: its settings and slots."""

from __future__ import annotations

from pathlib import Path

import ravestate as rs
from ravestate.modules import rawio

from .intents import Intent


class Settings(rs.Settings):
    """The language of the agent, and its phrases."""

    language: str = "en"
    """The language, e.g. ``de`` or ``de-AT``. An intent without phrases in it is said in English."""
    phrases: tuple[Path, ...] = ()
    """Your own files of phrases. They replace the modules' phrases, or add to them."""


module = rs.Module("verbaliser", requires=[rawio], settings=Settings)

intent: rs.Slot[str | Intent | None] = module.slot("intent", None, type=str | Intent, always=True)
"""The agent's next intent: a name, or an `Intent` with parameters. The agent says it at once."""

last: rs.Collection[str] = module.collection("last")
"""The template that was last used for each intent, by the intent's name."""
