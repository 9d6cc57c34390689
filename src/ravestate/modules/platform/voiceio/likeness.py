"""How surely a microphone's sound holds an echo of the loudspeaker's sound."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ravestate.modules.modality.rawio.line import IN_RATE

NEAR = 8000
"""The samples of the microphone's sound that are compared: 0.5 s."""
FAR = 24000
"""The samples of the loudspeaker's sound that are compared: an echo arrives within 1 s."""
EARLY = 1600
"""The samples by which the reference may be late: 0.1 s."""
_SIZE = 32768
_BAND = slice(200 * _SIZE // IN_RATE, 6000 * _SIZE // IN_RATE)
_EDGE = np.hanning(160)[80:]
"""Both sounds end at the same time. Without a soft end, these two ends would be alike."""


def likeness(near: NDArray[np.float32], far: NDArray[np.float32]) -> float:
    """Return the highest peak of the whitened correlation (GCC-PHAT), in standard deviations.

    An echo repeats the loudspeaker's sound at one delay, so all frequencies agree on it: the peak is mostly above 30, at
    any level. For another voice, it is about 10, and below 20 in the first moments.

    Args:
        near: The last `NEAR` samples of the microphone.
        far: The last `FAR` samples of the loudspeaker, up to the same time.
    """
    near, far = near.copy(), far.copy()
    near[-80:] *= _EDGE
    far[-80:] *= _EDGE
    cross = np.fft.rfft(near, _SIZE) * np.conj(np.fft.rfft(far, _SIZE))
    white = np.zeros_like(cross)
    white[_BAND] = cross[_BAND] / (np.abs(cross[_BAND]) + 1e-6 * np.abs(cross).max() + 1e-9)
    found = np.fft.irfft(white)
    # `near` begins FAR - NEAR samples behind `far`, so that is the shift without a delay.
    none = _SIZE - (FAR - NEAR)
    delays = np.roll(found, EARLY - none)[: EARLY + FAR - NEAR]
    return float(delays.max() / (np.std(found) + 1e-12))
