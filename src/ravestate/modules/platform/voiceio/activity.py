"""Voice activity: the probability that a sound is speech. The model is Silero, which comes with faster-whisper."""

from __future__ import annotations

from functools import lru_cache
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ravestate.errors import PlatformError
from ravestate.modules.modality.rawio.line import IN_RATE

from .sound import Samples, samples

CHUNK = 512
"""The model judges this many samples (32 ms) at a time."""
_CONTEXT = 64


class Activity:
    """The voice activity in one stream of sound."""

    def __init__(self) -> None:
        """Load the model.

        Raises:
            PlatformError: The model is missing.
        """
        self._session = _session()
        self.reset()

    def reset(self) -> None:
        """Forget the sound so far."""
        self._h: NDArray[np.float32] = np.zeros((1, 1, 128), np.float32)
        self._c: NDArray[np.float32] = np.zeros((1, 1, 128), np.float32)
        self._last: NDArray[np.float32] = np.zeros(_CONTEXT, np.float32)

    def probability(self, chunk: Samples) -> float:
        """Return the probability that the next `CHUNK` samples (16 kHz) are speech."""
        sound: NDArray[np.float32] = chunk.astype(np.float32) / np.float32(32768)
        given = np.concatenate([self._last, sound])[None, :]
        found, self._h, self._c = self._session.run(None, {"input": given, "h": self._h, "c": self._c})
        self._last = sound[-_CONTEXT:]
        return float(found.reshape(-1)[-1])


def speech_spans(pcm: bytes, above: float = 0.5, gap: float = 0.5) -> list[tuple[float, float]]:
    """Return the beginning and the end (seconds) of each span of speech in a sound (16 kHz).

    A chunk is speech if its probability is at least `above`. A pause shorter than `gap` seconds does not end a span.
    A span of a single chunk is left out.

    Raises:
        PlatformError: The model is missing.
    """
    judge, found = Activity(), list[tuple[float, float]]()
    sound = samples(pcm)
    for at in range(0, len(sound) - CHUNK + 1, CHUNK):
        if judge.probability(sound[at : at + CHUNK]) >= above:
            begin, end = at / IN_RATE, (at + CHUNK) / IN_RATE
            if found and begin - found[-1][1] < gap:
                found[-1] = found[-1][0], end
            else:
                found.append((begin, end))
    return [(begin, end) for begin, end in found if end - begin >= 2 * CHUNK / IN_RATE]


@lru_cache(maxsize=1)
def _session() -> Any:
    place = find_spec("faster_whisper")
    if place is None or place.origin is None or find_spec("onnxruntime") is None:
        raise PlatformError("voiceio needs faster-whisper and onnxruntime: pip install 'ravestate[voice]'")
    files = sorted((Path(place.origin).parent / "assets").glob("silero_vad*.onnx"))
    if not files:
        raise PlatformError("this faster-whisper has no model of voice activity: pip install -U faster-whisper")
    return session(files[-1])


def session(file: Path) -> Any:
    """Return the ONNX model in a file. It runs in one thread.

    Raises:
        PlatformError: The file cannot be loaded.
    """
    onnxruntime: Any = import_module("onnxruntime")  # the package has no types
    options = onnxruntime.SessionOptions()
    # Otherwise, integer products overflow on processors without VNNI, so probabilities would differ between machines.
    options.add_session_config_entry("session.x64quantprecision", "1")
    options.inter_op_num_threads = options.intra_op_num_threads = 1
    options.log_severity_level = 3
    try:
        return onnxruntime.InferenceSession(str(file), options, providers=["CPUExecutionProvider"])
    except Exception as error:
        raise PlatformError(f"voiceio: cannot load {file}: {error}") from error
