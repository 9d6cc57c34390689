"""The names of `fillers`: its settings, its module, its slots and signals.

A filler is a phrase such as "Let me think…", which the agent says when an answer is slow.
"""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

import ravestate as rs
from ravestate.modules import idle, rawio, verbaliser


class Settings(rs.Settings):
    """The delays of a filler, and of the answer after it."""

    unanswered_after: Annotated[float, Field(gt=0)] = 2.0
    """If the agent says nothing for this many seconds after the user's words, the answer counts as slow."""
    answer_within: Annotated[float, Field(gt=0)] = 20.0
    """Seconds from a filler until the agent says that the answer takes longer."""


module = rs.Module("fillers", requires=[rawio, idle, verbaliser], settings=Settings)

filled: rs.Slot[float | None] = module.slot("filled", None)
"""The time of the last filler, in seconds since the context began."""

waiting = module.flag("waiting")
"""Whether the user has said something and has heard no answer yet. The agent says a filler only while this is true."""

promised = module.flag("promised")
"""Whether the agent still owes an answer after a filler."""

late = module.signal("late")
"""The answer after a filler takes too long. It may still come."""

lost = module.signal("lost")
"""The agent still owes an answer after a filler, but no rule is left that could answer."""
