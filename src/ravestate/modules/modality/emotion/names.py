"""The module emotion: its settings, signals and slot."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

import ravestate as rs
from ravestate.modules import interloc, rawio

from .feeling import Feeling

__all__ = ["Settings", "affectionate", "felt", "happy", "module", "sad", "shy", "surprised"]

Probability = Annotated[float, Field(ge=0, le=1)]


class Settings(rs.Settings):
    """How easily the agent is moved, and whether it shows that in text."""

    shy: Probability = 0.1
    """How likely it is shy when something is said about it."""
    surprised: Probability = 0.03
    """How likely it is surprised when it is asked something."""
    happy: Probability = 0.25
    """How likely it is happy when it is greeted or thanked."""
    affectionate: Probability = 0.25
    """How likely it is affectionate when somebody says goodbye to it."""
    names: tuple[str, ...] = ()
    """What the agent is called, by default ``interloc.agent``: "Rosie is clever" is then as good as "you are clever"."""
    emoji: bool = True
    """Whether feelings show as emoji in ``rawio.output``; off where the agent has a face or speaks aloud."""


module = rs.Module("emotion", requires=[rawio, interloc], settings=Settings)

shy = module.signal("shy")
"""The agent is shy: it was paid a compliment, or is the subject of the talk."""

surprised = module.signal("surprised")
"""The agent is surprised."""

happy = module.signal("happy")
"""The agent is happy, for itself or with its user."""

affectionate = module.signal("affectionate")
"""The agent likes its user."""

sad = module.signal("sad")
"""The agent is sad: with its user, or because it was insulted."""

felt: rs.Slot[Feeling | None] = module.slot("felt", None, always=True, keep="latest")
"""What the agent felt last; None before it felt anything."""
