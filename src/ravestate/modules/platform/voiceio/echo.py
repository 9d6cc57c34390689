"""Echo cancellation: libspeexdsp removes the agent's own voice from the microphone's sound."""

from __future__ import annotations

import ctypes
import ctypes.util
from functools import lru_cache
from typing import Any

from ravestate.modules.modality.rawio.line import IN_RATE

FRAME = 320
"""The number of samples in a frame (20 ms)."""
TAIL = 4096
"""The canceller removes echoes that arrive within this many samples (256 ms)."""

# The codes of requests to the library.
_SET_RATE, _SET_DENOISE, _SET_STATE, _SET_SUPPRESS, _SET_SUPPRESS_ACTIVE = 24, 0, 24, 20, 22


class EchoCanceller:
    """The echo canceller of one line (a microphone and a loudspeaker).

    Raises:
        OSError: The library is not installed.
    """

    def __init__(self) -> None:
        self._library = library()
        self._echo = ctypes.c_void_p(self._library.speex_echo_state_init(FRAME, TAIL))
        rate = ctypes.c_int(IN_RATE)
        self._library.speex_echo_ctl(self._echo, _SET_RATE, ctypes.byref(rate))
        self._after = ctypes.c_void_p(self._library.speex_preprocess_state_init(FRAME, IN_RATE))
        for request, value in ((_SET_DENOISE, 0), (_SET_SUPPRESS, -50), (_SET_SUPPRESS_ACTIVE, -30)):
            self._library.speex_preprocess_ctl(self._after, request, ctypes.byref(ctypes.c_int(value)))
        self._library.speex_preprocess_ctl(self._after, _SET_STATE, self._echo)

    def clean(self, near: bytes, far: bytes) -> bytes:
        """Return the microphone's sound `near` without the echo of `far`, the loudspeaker's sound at the same time.

        Both are PCM of `FRAME` samples at `IN_RATE`.
        """
        out = ctypes.create_string_buffer(2 * FRAME)
        self._library.speex_echo_cancellation(self._echo, near, far, out)
        self._library.speex_preprocess_run(self._after, out)
        return out.raw

    def close(self) -> None:
        """Free the library's memory. Do not use the canceller after this call."""
        if self._echo:
            self._library.speex_preprocess_state_destroy(self._after)
            self._library.speex_echo_state_destroy(self._echo)
            self._echo = self._after = ctypes.c_void_p()


@lru_cache(maxsize=1)
def library() -> Any:
    """Return libspeexdsp.

    Raises:
        OSError: The library is not installed.
    """
    name = ctypes.util.find_library("speexdsp") or "libspeexdsp.so.1"
    found: Any = ctypes.CDLL(name)
    pointer, number = ctypes.c_void_p, ctypes.c_int
    for function, result, arguments in (
        ("speex_echo_state_init", pointer, [number, number]),
        ("speex_echo_ctl", number, [pointer, number, pointer]),
        ("speex_echo_cancellation", None, [pointer, pointer, pointer, pointer]),
        ("speex_echo_state_destroy", None, [pointer]),
        ("speex_preprocess_state_init", pointer, [number, number]),
        ("speex_preprocess_ctl", number, [pointer, number, pointer]),
        ("speex_preprocess_run", number, [pointer, pointer]),
        ("speex_preprocess_state_destroy", None, [pointer]),
    ):
        known = getattr(found, function)
        known.restype, known.argtypes = result, arguments
    return found
