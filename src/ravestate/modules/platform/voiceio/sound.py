"""Convert sounds: mono PCM bytes (16 bits, signed, little-endian), and files of many formats."""

from __future__ import annotations

import io
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ravestate.errors import PlatformError

Samples = NDArray[np.int16]
"""Mono samples, 16 bits."""

LONGEST = 3600.0
"""The maximum number of seconds to read from a file."""
FRAME = 0.02
"""`pieces` looks for a quiet moment in frames of this length (seconds)."""
QUIET = 15
"""A quiet moment has this many frames (0.3 s)."""


def samples(pcm: bytes) -> Samples:
    """Return PCM bytes as samples. Drop an odd byte at the end."""
    return np.frombuffer(pcm[: len(pcm) // 2 * 2], "<i2")


def seconds(pcm: bytes, rate: int) -> float:
    """Return the length of a sound in seconds. `rate` is in Hz."""
    return len(pcm) / 2 / rate


def silence(length: float, rate: int) -> bytes:
    """Return `length` seconds of silence."""
    return bytes(2 * max(0, round(length * rate)))


def pieces(pcm: bytes, rate: int, longest: float) -> Iterator[bytes]:
    """Yield a sound in pieces of at most `longest` seconds. Cut each piece at the quietest moment of its last third."""
    sound, most, frame = samples(pcm), round(longest * rate), round(FRAME * rate)
    while len(sound) > most:
        first = most * 2 // 3
        frames = sound[first : first + (most - first) // frame * frame].reshape(-1, frame).astype(np.float64)
        power = np.convolve((frames**2).mean(axis=1), np.ones(QUIET), "valid")
        cut = first + (int(power.argmin()) + QUIET // 2) * frame
        yield sound[:cut].tobytes()
        sound = sound[cut:]
    yield sound.tobytes()


def resample(pcm: bytes, old: int, new: int) -> bytes:
    """Return a sound at another rate (Hz)."""
    if old == new or not pcm:
        return pcm
    av = _av()
    resampler = av.AudioResampler(format="s16", layout="mono", rate=new)
    frame = av.AudioFrame.from_ndarray(samples(pcm).reshape(1, -1), format="s16", layout="mono")
    frame.sample_rate = old
    parts = [*resampler.resample(frame), *resampler.resample(None)]
    return b"".join(part.to_ndarray().astype("<i2").tobytes() for part in parts)


def decode(source: bytes | Path, rate: int) -> bytes:
    """Return the sound in a file (WAV, OGG, MP3, …) as PCM at `rate` (Hz). The channels are mixed.

    Raises:
        PlatformError: The file is missing, contains no sound, or is damaged at its beginning.
    """
    av = _av()
    name = str(source) if isinstance(source, Path) else f"{len(source)} bytes"
    parts: list[bytes] = []
    size = 0
    try:
        with av.open(str(source) if isinstance(source, Path) else io.BytesIO(source)) as container:
            resampler = av.AudioResampler(format="s16", layout="mono", rate=rate)
            try:
                for frame in container.decode(audio=0):
                    for part in resampler.resample(frame):
                        parts.append(part.to_ndarray().astype("<i2").tobytes())
                        size += len(parts[-1])
                    if size > LONGEST * rate * 2:
                        break
            except av.FFmpegError:
                if not parts:  # a truncated file still has a usable beginning
                    raise
            parts += [part.to_ndarray().astype("<i2").tobytes() for part in resampler.resample(None)]
    except (OSError, ValueError, IndexError) as error:
        reason = (
            "it holds no sound" if isinstance(error, IndexError) else getattr(error, "strerror", None) or str(error)
        )
        raise PlatformError(f"cannot read the sound of {name}: {reason}") from error
    if not parts:
        raise PlatformError(f"cannot read the sound of {name}: it holds no sound")
    return b"".join(parts)


def encode_ogg(pcm: bytes, rate: int) -> bytes:
    """Return a sound as an OGG file with Opus, the usual format of voice notes."""
    av = _av()
    target = io.BytesIO()
    with av.open(target, "w", format="ogg") as container:
        stream = container.add_stream("libopus", rate=48000, layout="mono")
        stream.bit_rate = 32000
        frame = av.AudioFrame.from_ndarray(samples(pcm).reshape(1, -1), format="s16", layout="mono")
        frame.sample_rate = rate
        resampler = av.AudioResampler(format="s16", layout="mono", rate=48000, frame_size=960)
        for part in (*resampler.resample(frame), *resampler.resample(None), None):
            for packet in stream.encode(part):
                container.mux(packet)
    return target.getvalue()


def write_wav(path: Path, pcm: bytes, rate: int) -> None:
    """Write a sound to a WAV file.

    Raises:
        PlatformError: The file cannot be written.
    """
    import wave

    try:
        with path.open("wb") as target, wave.open(target, "wb") as file:
            file.setnchannels(1)
            file.setsampwidth(2)
            file.setframerate(rate)
            file.writeframes(pcm)
    except OSError as error:
        raise PlatformError(f"cannot write {path}: {error.strerror}") from error


def _av() -> Any:
    try:
        import av
    except ImportError as error:
        raise PlatformError("voiceio needs PyAV: pip install 'ravestate[voice]'") from error
    return av
