"""The module, its settings and its slot."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

import ravestate as rs
from ravestate.modules import idle, rawio, verbaliser


class Settings(rs.Settings):
    """How long the agent waits before a filler."""

    unanswered_after: Annotated[float, Field(gt=0)] = 2.0
    """Seconds from the user's words until an answer counts as slow, if nothing has been said."""
    answer_within: Annotated[float, Field(gt=0)] = 20.0
    """Seconds from a filler until the agent says that it has lost the answer."""


module = rs.Module("fillers", requires=[rawio, idle, verbaliser], settings=Settings)

filled: rs.Slot[float | None] = module.slot("filled", None)
"""The time of the last filler, in seconds since the context began."""

promised = module.flag("promised")
"""Whether the agent still owes an answer after a filler."""

lost = module.signal("lost")
"""The answer after a filler does not come: it takes too long, or every rule that could answer has resigned."""
