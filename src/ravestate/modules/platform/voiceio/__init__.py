"""Speech: the agent listens to a microphone and speaks, and stops when it is interrupted."""

from __future__ import annotations

from . import rules as rules
from .manner import Prosody
from .names import (
    Settings,
    agent_speaking,
    another_speaks,
    back_channel,
    barge_in,
    conversation,
    false_alarm,
    heard,
    held,
    module,
    prosody,
    speech,
    spoke_up,
    user_speaking,
    utterance,
)
from .utterances import Utterance
from .voice_notes import speak, synthesise, transcribe

__all__ = [
    "Prosody",
    "Settings",
    "Utterance",
    "agent_speaking",
    "another_speaks",
    "back_channel",
    "barge_in",
    "conversation",
    "false_alarm",
    "heard",
    "held",
    "module",
    "prosody",
    "rules",
    "speak",
    "speech",
    "spoke_up",
    "synthesise",
    "transcribe",
    "user_speaking",
    "utterance",
]
