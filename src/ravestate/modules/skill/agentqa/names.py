"""Answers questions about the agent itself: who it is, where it comes from, what it likes, how it is."""

from __future__ import annotations

from collections.abc import Callable
from datetime import datetime
from pathlib import Path
from typing import Annotated

from pydantic import Field, field_validator
from pydantic_core import PydanticCustomError

import ravestate as rs
from ravestate.errors import RavestateError
from ravestate.modules import idle, interloc, nlp, ontology, rawio, verbaliser

from .life import Life
from .life_file import read_life
from .remarks import Remark
from .router import Match


class Settings(rs.Settings):
    """Who the agent is, and how often it offers to talk about itself."""

    life: Path | None = None
    """A file of one's own with facts and topics; it changes what it mentions, the rest is as it comes."""
    prompt_every: Annotated[float, Field(gt=0)] = 120.0
    """Seconds from one "ask me something" to the next, however silent it is."""

    @field_validator("life")
    @classmethod
    def _can_be_read(cls, path: Path | None) -> Path | None:
        """A mistake in the file is told before anything runs."""
        try:
            read_life(path)
        except RavestateError as error:
            raise PydanticCustomError("life", "{why}", {"why": str(error)}) from None
        return path


module = rs.Module("agentqa", requires=[rawio, idle, interloc, nlp, ontology, verbaliser], settings=Settings)

asked = module.signal("asked", payload=Match)
"""The user asks something about the agent; with the topic."""

remarked = module.signal("remarked", payload=Remark)
"""The user says something that is answered before all else, such as distress or an insult; with the topic."""

life: rs.Slot[Life | None] = module.slot("life", None, type=Life, input=True)
"""Who the agent is: read from the files at startup. Where memory has the agent's node, that one counts."""

mood: rs.Slot[str] = module.slot("mood", "fine", type=str, input=True)
"""How the agent is, as an adjective: what it says when it is asked how it is. Whoever knows better may write it."""


def machine_clock() -> datetime:
    """The moment where the machine is."""
    return datetime.now().astimezone()


clock: rs.Slot[Callable[[], datetime]] = module.slot("clock", machine_clock, input=True)
"""What tells the moment, by default the machine's clock; the agent's age, the date and the time of day follow from it."""

prompted: rs.Slot[float | None] = module.slot("prompted", None)
"""When the agent last offered to be asked, in seconds since the context began."""
