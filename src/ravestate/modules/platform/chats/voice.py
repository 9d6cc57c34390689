"""Voice notes: words in a recording, and words as a recording, where `voiceio` is installed."""

from __future__ import annotations

import asyncio
import importlib
import io
from typing import Any

from ravestate.errors import PlatformError
from ravestate.modules.modality.rawio import IN_RATE, OUT_RATE

VOICE = "ravestate.modules.platform.voiceio"


async def words_in(recording: bytes) -> str:
    """Return the words in a recording, such as an Ogg file with Opus sound.

    Raises:
        PlatformError: Speech recognition is not installed, or the recording is damaged.
    """
    return await asyncio.to_thread(_words_in, recording)


async def spoken(text: str) -> bytes | None:
    """Return a text as speech, in an Ogg file with Opus sound; None if speech synthesis is not installed."""
    try:
        return await asyncio.to_thread(_spoken, text)
    except PlatformError:
        return None


def _voiceio() -> Any:
    try:
        return importlib.import_module(VOICE)
    except ImportError as error:
        raise PlatformError("voice messages need voiceio: pip install 'ravestate[voice]'") from error


def _av() -> Any:
    try:
        return importlib.import_module("av")
    except ImportError as error:
        raise PlatformError("voice messages need av: pip install 'ravestate[voice]'") from error


def _words_in(recording: bytes) -> str:
    return str(_voiceio().transcribe(decoded(recording)).text)


def _spoken(text: str) -> bytes:
    return encoded(_voiceio().synthesise(text))


def decoded(recording: bytes) -> bytes:
    """Return the sound of a recording as mono PCM: 16 bits, little-endian, at `IN_RATE`."""
    av = _av()
    sound = bytearray()
    try:
        with av.open(io.BytesIO(recording)) as file:
            resampler = av.AudioResampler(format="s16", layout="mono", rate=IN_RATE)
            for frame in file.decode(audio=0):
                for each in resampler.resample(frame):
                    sound += each.to_ndarray().tobytes()
            for each in resampler.resample(None):
                sound += each.to_ndarray().tobytes()
    except (av.FFmpegError, IndexError, ValueError) as error:
        raise PlatformError(f"the recording cannot be read: {error}") from error
    return bytes(sound)


def encoded(sound: bytes) -> bytes:
    """Return mono PCM at `OUT_RATE` as an Ogg file with Opus sound."""
    av = _av()
    import numpy as np

    out = io.BytesIO()
    with av.open(out, "w", format="ogg") as file:
        stream = file.add_stream("libopus", rate=48_000, layout="mono")
        frame = av.AudioFrame.from_ndarray(np.frombuffer(sound, "<i2").reshape(1, -1), format="s16", layout="mono")
        frame.sample_rate = OUT_RATE
        resampler = av.AudioResampler(format=stream.format, layout="mono", rate=48_000)
        for part in (*resampler.resample(frame), *resampler.resample(None), None):
            for packet in stream.encode(part):
                file.mux(packet)
    return out.getvalue()
