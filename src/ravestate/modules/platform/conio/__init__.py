"""The console: what is typed is heard, what is said is printed."""

from __future__ import annotations

import ravestate as rs
from ravestate.modules import interloc, rawio

from .console import Console

__all__ = ["Console", "Settings", "module", "rules", "screen"]


class Settings(rs.Settings):
    """How the console looks, and what it keeps."""

    prompt: str = "> "
    """What stands before the line that is typed."""
    history: bool = True
    """Whether lines typed are kept from session to session, in the user's folder for state."""
    name: str | None = None
    """The name of whoever sits there, if it is known."""


module = rs.Module("conio", requires=(rawio, interloc), settings=Settings)

screen: rs.Slot[Console | None] = module.slot("screen", None)
"""The console while it is open."""

from . import rules  # noqa: E402  # it adds the rules to the module
