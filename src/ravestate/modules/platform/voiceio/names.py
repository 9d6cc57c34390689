"""The module: its settings, signals and slots."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal, cast

from pydantic import ConfigDict, Field

import ravestate as rs
from ravestate.modules import rawio, verbaliser

from .manner import Prosody
from .utterances import Utterance

if TYPE_CHECKING:
    from .ear import Turn
    from .mouth import Speech
    from .opening import Conversation

Seconds = Annotated[float, Field(ge=0)]
Share = Annotated[float, Field(ge=0, le=1)]


class Settings(rs.Settings):
    """The settings of voiceio: devices, models, and the timing of a conversation."""

    model_config = ConfigDict(protected_namespaces=())  # allow the field `model`

    source: str = "default"
    """The microphone: ``default``, a device's name, or a WAV file. A platform's line in ``rawio.sound`` goes first."""
    sink: str = "default"
    """The loudspeaker: ``default``, a device's name, or a WAV file; empty to drop the sound."""
    half_duplex: bool = False
    """Whether the agent is deaf while it speaks, so that nobody can interrupt it: for a loud loudspeaker."""
    echo_cancellation: bool = True
    """Whether the agent's own voice is removed from the microphone's sound (libspeexdsp)."""

    recogniser: Literal["whisper", "grammar"] = "whisper"
    """``whisper``: faster-whisper; ``grammar``: pocketsphinx, for a few commands."""
    model: str = ""
    """For whisper, a model's name or folder, by default the best model on this machine. For grammar, a file in JSGF."""
    language: str = "en"
    """The user's language; empty to detect it in each utterance."""
    threads: Annotated[int, Field(ge=0)] = 0
    """CPU threads of the recogniser; 0 takes up to four."""
    recogniser_timeout: Annotated[float, Field(gt=0)] = 20.0
    """The seconds after which a recogniser counts as stuck, and starts again. A piece of sound has at most 25 s."""
    captions: Seconds = 1.0
    """Seconds between two captions (``rawio.hearing``) while the user speaks; 0 for none."""

    voice: str = ""
    """``espeak``, ``espeak:en-gb``, ``piper``, or a Piper voice's name or file; by default Piper if it is set up."""
    piper: Path | None = None
    """The Python interpreter of Piper's environment, by default that of ``make voice``."""

    speech: Share = 0.5
    """The probability of speech above which a sound counts as speech."""
    pause: Annotated[float, Field(ge=0.1)] = 0.2
    """Seconds of silence after which the turn may be over."""
    doubtful_pause: Seconds = 1.2
    """The seconds of silence that end a turn whose words or melody sound unfinished."""
    longest_pause: Seconds = 1.4
    """Seconds of silence that end every turn."""
    complete: Share = 0.5
    """The probability of a complete turn (smart-turn) above which the melody sounds finished."""

    ask_back_below: Share = 0.38
    """The recogniser's confidence below which the agent asks back."""
    back_channel: Seconds = 1.0
    """The seconds of the user's speech after which it is more than an "mhm", so that the agent stops speaking."""
    filler_after: Seconds = 0.8
    """Seconds without an answer after which the agent says a filler; 0 for none."""
    fillers: tuple[str, ...] = ("Hm.", "Well.", "Let me see.")
    """The fillers."""


module = rs.Module("voiceio", requires=[rawio, verbaliser], settings=Settings)

another_speaks: rs.Signal[Turn] = module.signal("another_speaks", payload=cast("type[Turn]", object))
"""Another person has gone on after the first person. The payload is the first person's turn."""

utterance: rs.Signal[Utterance] = module.signal("utterance", payload=Utterance)
"""The user has finished a turn. The words also go to ``rawio.input`` if the recogniser is confident enough."""

user_speaking = module.flag("user_speaking")
"""True while the user speaks. A pause of `pause` seconds ends it."""

agent_speaking = module.flag("agent_speaking")
"""True while the agent's voice sounds."""

heard = rawio.heard
"""The part of the agent's last utterance that the user heard: the slot ``rawio.heard`` itself."""

spoke_up = module.signal("spoke_up", keep="latest")
"""The user's sound is certainly articulate speech, not a hum or a cough."""

back_channel = module.signal("back_channel", payload=str)
"""The user has only shown that they listen ("mhm", "yes", laughter) while the agent was speaking."""

false_alarm = module.signal("false_alarm", payload=str)
"""The sound was no turn of a user, but noise, a cough or the agent's own voice. The payload is the reason."""

barge_in = module.signal("barge_in")
"""The user interrupts: the agent stops speaking."""

held = module.flag("held")
"""True while the agent's speech is held, until it is clear whether the user interrupts."""

speech: rs.Signal[Speech] = module.signal("speech", payload=cast("type[Speech]", object))
"""The agent begins to speak an utterance, which may still grow."""

prosody: rs.Slot[Prosody] = module.slot("prosody", Prosody(), type=Prosody, input=True)
"""The manner of the agent's speech. A module `emotion` in the agent sets it."""

conversation: rs.Slot[Conversation | None] = module.slot("conversation", None)
"""The open line with its ear, mouth and models; None while no line is open."""
