"""Speech recognition, in its own process."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from importlib.util import find_spec
from pathlib import Path
from threading import Event

from ravestate.errors import PlatformError
from ravestate.language.cores import cores
from ravestate.modules.modality.rawio.line import IN_RATE

from . import model_process
from .models import whisper_model
from .settings import Settings
from .sound import pieces

LONGEST = 25.0
"""The maximum number of seconds of sound in one request. A whisper model reads 30 s, including silence at the end."""

_MARKS = re.compile(r"\[[^\]]*\]|\([^)]*\)|\*[^*]*\*|[♪♫]+")
"""A recogniser's notes about sounds other than speech, for example ``[Music]`` or ``(coughs)``."""

# Whisper has learnt these phrases from the last words of films, and writes them for noise and silence.
_PHANTOMS = frozenset(
    {"i", "you", "thank you", "thanks for watching", "thank you for watching", "bye", "the end", "so"}
)


@dataclass(frozen=True, slots=True)
class Recognised:
    """The recognised words of a sound.

    Attributes:
        text: The words; empty if there are none.
        confidence: The recogniser's confidence, from 0 to 1.
        last: The candidates for the last word, with their probabilities; empty if the recogniser gives none.
    """

    text: str
    confidence: float
    last: Mapping[str, float] = field(default_factory=dict[str, float])


class Recogniser:
    """The recogniser that the settings name. All methods block and are thread-safe.

    Raises:
        PlatformError: A package or the model is missing; the message says how to get it.
    """

    def __init__(self, settings: Settings) -> None:
        self._patience = settings.recogniser_timeout
        if settings.recogniser == "grammar":
            if find_spec("pocketsphinx") is None:
                raise PlatformError("voiceio.recogniser=grammar needs pocketsphinx: pip install 'ravestate[voice]'")
            grammar = Path(settings.model).expanduser().absolute()
            if not settings.model or not grammar.is_file():
                missing = f"there is no file {settings.model!r}" if settings.model else "none is named"
                raise PlatformError(
                    f"voiceio.recogniser=grammar needs a grammar file (JSGF), but {missing}: "
                    "--set voiceio.model=commands.gram"
                )
            self._process = model_process.take("grammar", {"path": str(grammar)})
        else:
            if find_spec("faster_whisper") is None:
                raise PlatformError("voiceio needs faster-whisper: pip install 'ravestate[voice]'")
            config = {
                "path": str(whisper_model(settings.model)),
                "language": settings.language.partition("-")[0].lower(),  # Whisper does not know the region of `en-US`
                "threads": settings.threads or min(4, cores()),
                "exact": False,
            }
            self._process = model_process.take("whisper", config)

    @property
    def process(self) -> model_process.ModelProcess:
        """The model's process."""
        return self._process

    @property
    def busy(self) -> bool:
        """Whether the recogniser is working on a sound."""
        return self._process.busy

    def load(self) -> None:
        """Load the model, unless it is loaded."""
        self._process.start()

    def recognise(self, pcm: bytes, *, partial: bool = False, unwanted: Event | None = None) -> Recognised:
        """Return the words of a sound (16 kHz).

        A sound may have any length, because the recogniser gets it in pieces. Other requests may come between pieces.

        Args:
            pcm: The sound.
            partial: Whether the sound is the beginning of an utterance, for a caption. This is quicker, but less exact.
            unwanted: An event that another thread sets if the words are no longer needed. Then the
                recogniser skips the rest of the pieces.

        Raises:
            PlatformError: The recogniser fails, or does not answer in time, in two attempts (for a caption, in one). Or
                the words are no longer needed.
        """
        found: list[tuple[float, Recognised]] = []
        for piece in pieces(pcm, IN_RATE, LONGEST):
            one = self._recognise(piece, partial, unwanted)
            if one.text:
                found.append((float(len(one.text)), one))
        if len(found) < 2:
            return found[0][1] if found else Recognised("", 0.0)
        confidence = sum(length * one.confidence for length, one in found) / sum(length for length, _ in found)
        return Recognised(" ".join(one.text for _, one in found), confidence, found[-1][1].last)

    def _recognise(self, pcm: bytes, partial: bool, unwanted: Event | None) -> Recognised:
        header = {"partial": partial}
        try:
            answer, _ = self._process.request(header, pcm, seconds=self._patience, unwanted=unwanted)
        except PlatformError:
            if partial or (unwanted is not None and unwanted.is_set()):
                raise
            answer, _ = self._process.request(header, pcm, seconds=self._patience, unwanted=unwanted)
        found = _cleaned(answer["text"], answer["confidence"], answer["no_speech"])
        return replace(found, last=answer.get("last", {})) if found.text else found

    def close(self, *, linger: bool = False) -> None:
        """Release the model. If it has no other user, its process ends immediately, or with `linger` after a while."""
        model_process.drop(self._process, linger=linger)


def _cleaned(text: str, confidence: float, no_speech: float) -> Recognised:
    """Return recognised words without notes about sounds. For a sound that is hardly speech, return no words."""
    text = " ".join(_MARKS.sub(" ", text).split())
    bare = "".join(c for c in text.casefold() if c.isalnum() or c == " ").strip()
    if not any(c.isalnum() for c in text) or (no_speech > 0.6 and confidence < 0.6):
        return Recognised("", confidence)
    if bare in _PHANTOMS and (no_speech > 0.3 or confidence < 0.4):
        return Recognised("", confidence)
    return Recognised(text, confidence)
