"""The module idle: its settings, signals and slots."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

import ravestate as rs
from ravestate.modules import rawio

Seconds = Annotated[float, Field(ge=0)]


class Settings(rs.Settings):
    """The lengths of awkward pauses."""

    bored_after: Seconds = 15.0
    """Seconds without activity after which the agent is bored."""
    answer_time: Seconds = 25.0
    """If the agent has just asked a question: seconds without activity after which the agent is bored. A value below
    ``bored_after`` has no effect."""
    writing_time: Seconds = 20.0
    """Seconds since the last key press after which the agent is bored, if the user has typed a line but not sent it. A
    value below ``bored_after`` has no effect."""
    remarks: Annotated[int, Field(ge=0)] = 2
    """The maximum number of remarks that the bored agent makes before the user says, types or shows something."""
    impatient_after: Seconds = 1.0
    """Seconds that ready rules wait before the agent is impatient."""


module = rs.Module("idle", requires=[rawio], settings=Settings)

bored = module.signal("bored")
"""There was no activity for ``bored_after`` seconds. Each silence raises this signal once, including the
silence after startup.

A rule that speaks ends the silence. If the user ignores ``remarks`` remarks in a row, asks for quiet or says goodbye,
the signal is not raised until the user speaks again. After words of sorrow, the signal is not raised until the user
has spoken twelve more times.
"""

hushed = module.signal("hushed")
"""The user wants quiet: they have said, for example, "stop" or "please be quiet"."""

impatient = module.signal("impatient")
"""For ``impatient_after`` seconds, a ready rule was waiting at each moment."""

asked: rs.Slot[str] = module.slot("asked", "")
"""The question at the end of the agent's last utterance; empty if there is no question."""

remarked: rs.Slot[bool] = module.slot("remarked", True)
"""Whether the agent or the user has said, typed or shown anything since the agent was last bored."""

unanswered: rs.Slot[int] = module.slot("unanswered", 0)
"""The number of remarks that the agent has made out of boredom since the user last said, typed or showed something."""

dismissed = module.flag("dismissed")
"""Whether the user's last words ask for quiet or say goodbye."""

sorrow: rs.Slot[int] = module.slot("sorrow", 0)
"""The number of further utterances for which the user's last words of sorrow still count."""
