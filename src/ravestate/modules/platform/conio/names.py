"""The names of `conio`: its settings, its module and its slot."""

from __future__ import annotations

import ravestate as rs
from ravestate.modules import interloc, rawio

from .console import Console


class Settings(rs.Settings):
    """The settings of conio: the look of the console, and the data that it keeps."""

    prompt: str = "> "
    """The text before the line that the user types."""
    history: bool = True
    """Whether typed lines are kept from session to session, in the user's state folder."""
    plain: bool = False
    """Whether a terminal is used like a pipe: plain lines, without prompt_toolkit."""
    name: str | None = None
    """The name of the user at the console; None if it is unknown."""


module = rs.Module("conio", requires=(rawio, interloc), settings=Settings)

screen: rs.Slot[Console | None] = module.slot("screen", None)
"""The console; None if it is not open."""
