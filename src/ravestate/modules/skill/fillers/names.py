"""Fills a pause: "Let me think..." when an answer takes its time."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

import ravestate as rs
from ravestate.modules import idle, rawio, verbaliser


class Settings(rs.Settings):
    """When an answer takes long."""

    unanswered_after: Annotated[float, Field(gt=0)] = 2.0
    """Seconds from the user's words until an answer that is being made, and of which nothing is heard yet, takes long."""


module = rs.Module("fillers", requires=[rawio, idle, verbaliser], settings=Settings)

filled: rs.Slot[float | None] = module.slot("filled", None)
"""When a pause was filled last, in seconds since the context began."""
