"""Functions that find an echo of the loudspeaker in a microphone's sound, and measure its strength."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ravestate.modules.modality.rawio.line import IN_RATE

NEAR = 8000
"""A comparison uses this many samples (0.5 s) of the microphone's sound."""
FAR = 24000
"""A comparison uses this many samples (1.5 s) of the loudspeaker's sound. So it finds echoes that arrive within 1 s."""
EARLY = 1600
"""The loudspeaker's sound may be reported up to this many samples (0.1 s) later than its echo."""
_SIZE = 32768
WINDOW = 1024
"""The number of samples in a window of `strength`. Its 64 ms hold most of an echo."""
_BAND = slice(200 * _SIZE // IN_RATE, 6000 * _SIZE // IN_RATE)
_WINDOW = np.hanning(WINDOW).astype(np.float32)
_EDGE = np.hanning(160)[80:]
"""The fade-out for both sounds. Both are cut off at the same time, so two abrupt ends would look like an echo."""


def likeness(near: NDArray[np.float32], far: NDArray[np.float32]) -> tuple[float, int]:
    """Return the highest peak of the whitened correlation (GCC-PHAT), in standard deviations, and its delay in samples.

    An echo repeats the loudspeaker's sound at one delay, so all frequencies agree on this delay. The peak is then
    usually above 30, at any level. For another voice, the peak is about 10; with few samples, it can reach 20.

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
    # `near` begins FAR - NEAR samples after `far`, so this is the shift for a delay of zero.
    none = _SIZE - (FAR - NEAR)
    delays = np.roll(found, EARLY - none)[: EARLY + FAR - NEAR]
    best = int(delays.argmax())
    return float(delays[best] / (np.std(found) + 1e-12)), best - EARLY


def strength(near: NDArray[np.float32], far: NDArray[np.float32], delay: int) -> float:
    """Return the share of the loudspeaker's power that the microphone hears, even while a person is speaking.

    In each band, only the part of the microphone's power that follows the loudspeaker's sound counts (Welch's
    coherence). The power of another voice is divided by the number of windows: with 14 windows, it counts 11 dB less.

    Args:
        near, far: As for `likeness`.
        delay: The delay of the echo (samples), from `likeness`.
    """
    begin, count = FAR - NEAR - delay, min(NEAR, NEAR + delay)
    x, y = _spectra(far[begin : begin + count]), _spectra(near[:count])
    both, power = np.abs((y * np.conj(x)).mean(axis=0)) ** 2, (np.abs(x) ** 2).mean(axis=0) + 1e-9
    return float((both / power).sum() / power.sum())


def _spectra(sound: NDArray[np.float32]) -> NDArray[np.complex128]:
    starts = range(0, len(sound) - WINDOW + 1, WINDOW // 2)
    return np.fft.rfft(np.stack([sound[at : at + WINDOW] for at in starts]) * _WINDOW)
