"""Speech synthesis, in its own process."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from ravestate.errors import PlatformError
from ravestate.modules.modality.rawio.line import IN_RATE, OUT_RATE

from . import model_process
from .alignment import Word, by_phonemes, by_places
from .manner import Prosody
from .models import piper_python, piper_voice
from .settings import Settings
from .sound import resample, seconds

PATIENCE = 20.0
"""The synthesis of a sentence may take this many seconds."""


@dataclass(frozen=True, slots=True)
class Spoken:
    """A text as sound.

    Attributes:
        text: The text.
        sound: PCM at `OUT_RATE`.
        reference: The same sound at `IN_RATE`, for the echo canceller.
        words: The words in order, with the time at which each begins.
    """

    text: str
    sound: bytes
    reference: bytes
    words: tuple[Word, ...]


class Synthesiser:
    """The voice that the settings name. All methods block and are thread-safe.

    A voice varies at random from sentence to sentence, but in the same way in each new process. So a repeated
    conversation sounds the same only if no other conversation uses the voice's process.

    Args:
        settings: The settings of voiceio.
        shared: Whether other conversations with the same voice use the same process.

    Raises:
        PlatformError: A program or a voice is missing; the message says how to get it.
    """

    def __init__(self, settings: Settings, *, shared: bool = True) -> None:
        kind, _, name = settings.voice.partition(":")
        python = None if kind == "espeak" else piper_python(settings.piper)
        voice = None if kind == "espeak" else piper_voice("" if settings.voice == "piper" else settings.voice)
        if python and voice:
            self.name = f"piper:{voice.stem}"
            self._process = model_process.take("piper", {"voice": str(voice)}, python, shared=shared)
        elif kind in ("", "espeak"):
            self.name = f"espeak:{name or settings.language or 'en'}"
            self._process = model_process.take("espeak", {"voice": name or settings.language or "en"}, shared=shared)
        elif voice is None:
            raise PlatformError(
                f"voiceio has no voice {settings.voice!r}: name a file of a Piper voice (.onnx), or espeak, or espeak:en-gb"
            )
        else:
            raise PlatformError(
                "voiceio needs Piper for this voice: `make voice` sets it up, or name its Python in voiceio.piper"
            )

    @property
    def process(self) -> model_process.ModelProcess:
        """The voice's process."""
        return self._process

    def load(self) -> None:
        """Load the voice, unless it is loaded."""
        self._process.start()

    def speak(self, text: str, prosody: Prosody | None = None) -> Spoken:
        """Return a text as sound. `prosody` is the manner of speech; None is the voice's normal manner.

        Raises:
            PlatformError: The program fails, or does not answer in time.
        """
        style = prosody or Prosody()
        header = {"text": text, "rate": style.rate, "pitch": style.pitch, "range": style.range}
        answer, sound = self._process.request(header, seconds=PATIENCE)
        sound = resample(sound, answer["rate"], OUT_RATE)
        reference = resample(sound, OUT_RATE, IN_RATE)
        return Spoken(text, sound, reference, _words(text, answer, seconds(sound, OUT_RATE)))

    def close(self, *, linger: bool = False) -> None:
        """Release the voice. If it has no other user, its process ends immediately, or with `linger` after a while."""
        model_process.drop(self._process, linger=linger)


def _words(text: str, answer: dict[str, Any], length: float) -> tuple[Word, ...]:
    """Return the words of a text with their times, from the answer of the backend."""
    if "places" in answer:
        return by_places(text, [(place, time) for place, time in answer["places"]], length)
    return by_phonemes(text, [(time, count) for time, count in answer["spoken"]], length)
