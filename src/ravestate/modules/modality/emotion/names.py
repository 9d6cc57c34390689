"""The names of `emotion`: its settings, its module, its signals and slots."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

import ravestate as rs
from ravestate.modules import interloc, rawio

from .feeling import Feeling

Probability = Annotated[float, Field(ge=0, le=1)]


class Settings(rs.Settings):
    """The probabilities of spontaneous feelings, the agent's names, and whether feelings show as emoji."""

    shy: Probability = 0.1
    """The probability that the agent is shy when the user talks about it."""
    surprised: Probability = 0.0
    """The probability that a question surprises the agent."""
    happy: Probability = 0.25
    """The probability that a greeting or thanks makes the agent happy."""
    affectionate: Probability = 0.25
    """The probability that a goodbye makes the agent affectionate."""
    names: tuple[str, ...] = ()
    """The agent's names. Default: ``interloc.agent``. "Rosie is clever" means the same as "you are clever"."""
    emoji: bool = True
    """Whether feelings show as emoji in ``rawio.output``. Switch it off for an agent with a face or a voice."""


module = rs.Module("emotion", requires=[rawio, interloc], settings=Settings)

shy = module.signal("shy")
"""The agent is shy, because the user pays it a compliment or talks about it."""

surprised = module.signal("surprised")
"""The agent is surprised, because the user is surprised or asks a question."""

happy = module.signal("happy")
"""The agent is happy, because the user is happy, greets or says thanks."""

affectionate = module.signal("affectionate")
"""The agent feels affection, because the user shows affection or says goodbye."""

sad = module.signal("sad")
"""The agent is sad, because the user is sad or has insulted it."""

felt: rs.Slot[Feeling | None] = module.slot("felt", None, always=True, keep="latest")
"""The agent's last feeling; None before the first feeling."""

sorrow: rs.Slot[int] = module.slot("sorrow", 0)
"""The number of utterances for which the user's words of sorrow still count, including the last utterance."""
