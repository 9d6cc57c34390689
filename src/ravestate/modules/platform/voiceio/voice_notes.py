"""Voice notes: turn recordings into text, and text into recordings."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from ravestate.modules.modality.rawio.line import IN_RATE, OUT_RATE

from .names import module
from .settings import Settings
from .utterances import Utterance

if TYPE_CHECKING:
    from .recogniser import Recogniser
    from .synthesiser import Synthesiser


def transcribe(sound: bytes | Path, settings: Settings | None = None) -> Utterance:
    """Return the words of a recording. The call blocks, so make it in a thread.

    Args:
        sound: A file or its bytes, in any usual format: WAV, OGG with Opus, MP3, M4A.
        settings: The settings of voiceio; by default, those of the environment.

    Returns:
        The utterance. Its times count from the beginning of the recording. Its text is empty if nobody speaks.

    Raises:
        PlatformError: The recording cannot be read, a package or a model is missing, or the recogniser fails.
    """
    from .activity import speech_spans
    from .sound import decode

    settings = settings or settings_here()
    pcm = decode(sound, IN_RATE)
    spans = speech_spans(pcm, settings.speech)
    if not spans:
        return Utterance("", 0.0, 0.0, len(pcm) / 2 / IN_RATE)
    found = _recogniser(settings).recognise(pcm)
    return Utterance(found.text, found.confidence, spans[0][0], spans[-1][1])


def synthesise(text: str, settings: Settings | None = None) -> bytes:
    """Return a text as a voice note: an OGG file with Opus. The call blocks, so make it in a thread.

    Raises:
        PlatformError: A program or a voice is missing, synthesis fails, or the text has no words.
    """
    from .sound import encode_ogg

    return encode_ogg(speak(text, settings), OUT_RATE)


def speak(text: str, settings: Settings | None = None) -> bytes:
    """Return a text as PCM (mono, 16 bits, `OUT_RATE`). The call blocks.

    Raises:
        PlatformError: A program or a voice is missing, synthesis fails, or the text has no words.
    """
    from ravestate.errors import PlatformError

    from .sentences import sentences, speakable

    spoken = [speakable(sentence) for _, sentence in sentences(text, whole=True)]
    if not any(spoken):
        raise PlatformError(f"there are no words to speak in {text[:40]!r}")
    voice = _synthesiser(settings or settings_here())
    return b"".join(voice.speak(sentence).sound for sentence in spoken if sentence)


def settings_here() -> Settings:
    """Return the module's settings from the environment."""
    from ravestate.settings import load_settings

    return load_settings([module])[module.name]


_recognisers: dict[str, Recogniser] = {}
_synthesisers: dict[str, Synthesiser] = {}


def _recogniser(settings: Settings) -> Recogniser:
    """Return the recogniser for these settings. It stays loaded for the next note."""
    from .recogniser import Recogniser

    key = settings.model_dump_json()
    if key not in _recognisers:
        _recognisers[key] = Recogniser(settings)
    return _recognisers[key]


def _synthesiser(settings: Settings) -> Synthesiser:
    """Return the voice for these settings. It stays loaded for the next note."""
    from .synthesiser import Synthesiser

    key = settings.model_dump_json()
    if key not in _synthesisers:
        _synthesisers[key] = Synthesiser(settings)
    return _synthesisers[key]
