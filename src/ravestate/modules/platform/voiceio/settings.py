"""The settings of `voiceio`."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Annotated, Literal

from pydantic import AfterValidator, ConfigDict, Field

import ravestate as rs
from ravestate.settings import NameOrPath


def _language(code: str) -> str:
    if code and not re.fullmatch(r"[a-z]{2,3}(-[a-z0-9]+)*", code, re.IGNORECASE):
        raise ValueError("write the code of a language, such as de or de-AT, or leave it empty to detect the language")
    return code


Seconds = Annotated[float, Field(ge=0, allow_inf_nan=False)]
Share = Annotated[float, Field(ge=0, le=1)]


class Settings(rs.Settings):
    """The settings of voiceio: devices, models, and the timing of a conversation."""

    model_config = ConfigDict(protected_namespaces=())  # allow the field `model`

    source: NameOrPath = "default"
    """The microphone: ``default``, a device's name, or a sound file (WAV, OGG, MP3, ...). A platform's line in
    ``rawio.sound`` takes priority."""
    sink: NameOrPath = "default"
    """The loudspeaker: ``default``, a device's name, or a WAV file; empty to drop the sound."""
    half_duplex: bool = False
    """Whether the agent is deaf while it speaks. This helps with a loud loudspeaker, but prevents interruptions."""
    echo_cancellation: bool = True
    """Whether the agent's own voice is removed from the microphone's sound (libspeexdsp)."""

    recogniser: Literal["whisper", "grammar"] = "whisper"
    """``whisper``: faster-whisper; ``grammar``: pocketsphinx, for a few commands."""
    model: NameOrPath = ""
    """For whisper, a model's name or folder, by default the best model on this machine. For grammar, a file in JSGF."""
    language: Annotated[str, AfterValidator(_language)] = "en"
    """The code of the user's language, such as ``de`` or ``de-AT``; empty to detect the language in each utterance."""
    threads: Annotated[int, Field(ge=0)] = 0
    """CPU threads of the recogniser; 0 takes up to four."""
    recogniser_timeout: Annotated[float, Field(gt=0, le=3600)] = 20.0
    """The time limit for recognising up to 25 s of sound (seconds). A slower recogniser counts as stuck, and is started
    again."""
    captions: Seconds = 1.0
    """The seconds between two captions (``rawio.hearing``) while the user speaks; 0 for no captions."""

    voice: NameOrPath = ""
    """``espeak``, ``espeak:en-gb``, ``piper``, or a Piper voice's name or file; by default Piper if it is set up, else espeak."""
    piper: Path | None = None
    """The Python interpreter of Piper's environment. By default, this interpreter if it has Piper, else the one that
    ``make voice`` installs."""

    speech: Share = 0.5
    """The minimum probability of speech for a sound to count as speech."""
    pause: Annotated[float, Field(ge=0.1, allow_inf_nan=False)] = 0.2
    """This many seconds of silence are a pause. They also end a turn whose words and melody (rise and fall of the
    voice) are complete."""
    doubtful_pause: Seconds = 1.2
    """This many seconds of silence end a turn that may be incomplete."""
    longest_pause: Seconds = 1.4
    """This many seconds of silence end every turn."""
    complete: Share = 0.5
    """The minimum probability for a melody to count as complete (smart-turn)."""

    ask_back_below: Share = 0.38
    """The agent asks back if the recogniser's confidence is below this."""
    back_channel: Seconds = 1.0
    """If the user speaks longer than this (seconds), their words are more than an "mhm", and the agent stops speaking."""
    filler_after: Seconds = 0.8
    """The agent says a filler after this many seconds without an answer; 0 for no fillers."""
    fillers: tuple[str, ...] = ("Hm.", "Well.", "Let me see.")
    """The fillers; the agent chooses one of them at random."""
