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
    answer_within: Annotated[float, Field(gt=0)] = 20.0
    """Seconds from a filler until the agent says that it has lost the answer."""


module = rs.Module("fillers", requires=[rawio, idle, verbaliser], settings=Settings)

filled: rs.Slot[float | None] = module.slot("filled", None)
"""When a pause was filled last, in seconds since the context began."""

promised = module.flag("promised")
"""Whether a filler was said, and the answer after it has not come yet."""

lost = module.signal("lost")
"""A filler was said, and no answer comes any more: it took too long, or every rule for it resigned."""
