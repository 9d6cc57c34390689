"""The module agentqa: its settings, slots and signals."""

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
    """The agent's life file, and the delay before the agent offers to talk about itself."""

    life: Path | None = None
    """The designer's life file. Its facts and topics change those of the same name in the built-in file."""
    prompt_after: Annotated[float, Field(gt=0)] = 60.0
    """Seconds from `idle.bored` to the agent's invitation to ask about the agent. This happens only once, and only after
    six utterances of the user."""

    @field_validator("life")
    @classmethod
    def _can_be_read(cls, path: Path | None) -> Path | None:
        """Report a mistake in the file before anything runs."""
        try:
            read_life(path)
        except RavestateError as error:
            raise PydanticCustomError("life", "{why}", {"why": str(error)}) from None
        return path


module = rs.Module("agentqa", requires=[rawio, idle, interloc, nlp, ontology, verbaliser], settings=Settings)

asked = module.signal("asked", payload=Match)
"""The user asks something about the agent; the payload has the topic."""

remarked = module.signal("remarked", payload=Remark)
"""The user insults the agent, shows distress, or makes another remark that needs a response. This response outranks
nearly all other answers. The payload has the topic."""

life: rs.Slot[Life | None] = module.slot("life", None, type=Life, input=True)
"""The agent's life (its facts and topics), read at startup from the built-in file and the designer's file. Facts in the
agent's memory override the facts from the files."""

mood: rs.Slot[str] = module.slot("mood", "fine", type=str, input=True)
"""The agent's mood as an adjective, for the answer to *how are you*. Any module may write this slot."""


def machine_clock() -> datetime:
    """Return the current moment in the machine's time zone."""
    return datetime.now().astimezone()


clock: rs.Slot[Callable[[], datetime]] = module.slot("clock", machine_clock, input=True)
"""The clock for the agent's age, the date and the time of day; by default, the machine's clock."""

prompted: rs.Slot[float | None] = module.slot("prompted", None)
"""The time when the agent invited the user to ask about the agent, in seconds since the context began. None if the agent
has not done so."""

turns: rs.Slot[tuple[int, float]] = module.slot("turns", (0, 0.0))
"""The number of the user's utterances, and the time of the last one, in seconds since the context began."""
