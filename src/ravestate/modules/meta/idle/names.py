"""The module idle: its settings, signals and slot."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

import ravestate as rs
from ravestate.modules import rawio

__all__ = ["Settings", "asked", "bored", "hushed", "impatient", "module", "remarked", "unanswered"]

Seconds = Annotated[float, Field(ge=0)]


class Settings(rs.Settings):
    """When a pause is awkward."""

    bored_after: Seconds = 5.0
    """Seconds without activity after which the agent is bored."""
    answer_time: Seconds = 12.0
    """Seconds that the user has for an answer to the agent's own question, if that is longer."""
    writing_time: Seconds = 20.0
    """Seconds from the last key pressed, while a line is not sent, after which the agent is bored all the same."""
    remarks: Annotated[int, Field(ge=0)] = 2
    """How many remarks in a row the agent makes of its own accord while the user says and writes nothing."""
    impatient_after: Seconds = 1.0
    """Seconds for which a ready rule is kept waiting before the agent is impatient."""


module = rs.Module("idle", requires=[rawio], settings=Settings)

bored = module.signal("bored")
"""Nothing has happened for ``bored_after`` seconds; once for each stretch of quiet (from startup on), and an answer to
it begins a new one. Not raised after ``remarks`` remarks without an answer, nor after the user has asked for quiet or
said goodbye: then the agent stays quiet until the user speaks again."""

hushed = module.signal("hushed")
"""The user wants quiet: "shut up", "stop", "please be quiet"."""

impatient = module.signal("impatient")
"""Something has been due for ``impatient_after`` seconds: an answer takes its time."""

asked: rs.Slot[str] = module.slot("asked", "")
"""The question with which the agent ended what it said last; empty if it asked nothing."""

remarked: rs.Slot[bool] = module.slot("remarked", True)
"""Whether the agent has said something since it was bored last."""

unanswered: rs.Slot[int] = module.slot("unanswered", 0)
"""The remarks that the agent has made out of boredom since the user said or wrote something."""
