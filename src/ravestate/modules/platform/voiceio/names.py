"""The names of `voiceio`: its module, its signals and slots."""

from __future__ import annotations

from typing import TYPE_CHECKING, cast

import ravestate as rs
from ravestate.modules import rawio, verbaliser

from .manner import Prosody
from .settings import Settings
from .utterances import Utterance

if TYPE_CHECKING:
    from .ear import Turn
    from .mouth import Speech
    from .opening import Conversation

module = rs.Module("voiceio", requires=[rawio, verbaliser], settings=Settings)

another_speaks: rs.Signal[Turn] = module.signal("another_speaks", payload=cast("type[Turn]", object))
"""Another person has begun to speak after the first one. The payload is the first person's turn."""

utterance: rs.Signal[Utterance] = module.signal("utterance", payload=Utterance)
"""The user has finished a turn, so the agent may answer. The words also go to ``rawio.input`` if the recogniser is
confident enough."""

user_speaking = module.flag("user_speaking")
"""True while the user speaks. It becomes false after `pause` seconds of silence."""

agent_speaking = module.flag("agent_speaking")
"""True while the agent's voice is audible."""

heard = rawio.heard
"""The part of the agent's last utterance that the user heard: the slot ``rawio.heard`` itself."""

spoke_up = module.signal("spoke_up", keep="latest")
"""The user's sound is certainly articulate speech, not a hum or a cough."""

back_channel = module.signal("back_channel", payload=str)
"""The user has only shown that they listen ("mhm", "yes", laughter) while the agent was speaking. The payload is their
words."""

false_alarm = module.signal("false_alarm", payload=str)
"""The sound was not a user's turn, but noise, a cough or the agent's own voice. The payload is the reason."""

barge_in = module.signal("barge_in")
"""The user interrupts: the agent stops speaking."""

held = module.flag("held")
"""True while the agent's speech is paused, until it is clear whether the user interrupts."""

speech: rs.Signal[Speech] = module.signal("speech", payload=cast("type[Speech]", object))
"""The agent begins to speak an utterance, which may still grow."""

prosody: rs.Slot[Prosody] = module.slot("prosody", Prosody(), type=Prosody, input=True)
"""The manner of the agent's speech. If the agent has the module `emotion`, its feelings set this slot."""

conversation: rs.Slot[Conversation | None] = module.slot("conversation", None)
"""The open line (the sound to and from one user) with its ear, mouth and models; None if no line is open."""
