"""The pitch of a voice, to notice that another person goes on."""

from __future__ import annotations

import numpy as np

from ravestate.modules.modality.rawio.line import IN_RATE

from .sound import Samples

FRAME = 640
"""The samples of a frame: 40 ms."""
LOWEST, HIGHEST = 70.0, 400.0
"""The range of speaking voices (Hz)."""
PERIODIC = 0.6
"""The correlation with itself, one period later, above which a frame is voiced."""
ENOUGH = 8
"""The voiced frames that tell a voice's pitch."""
ANOTHER = 1.6
"""The ratio of two pitches above which they are two people: one person's voice moves less on average."""


def pitch(sound: Samples) -> float | None:
    """Return the median pitch (Hz) of the voiced parts of a sound (16 kHz); None if there is too little voice."""
    found: list[float] = []
    wave = sound.astype(np.float64)
    shortest, longest = int(IN_RATE / HIGHEST), int(IN_RATE / LOWEST)
    for at in range(0, len(wave) - FRAME - longest, FRAME):
        frame = wave[at : at + FRAME]
        if np.abs(frame).max() < 500:
            continue
        power = float(frame @ frame)
        later = np.lib.stride_tricks.sliding_window_view(wave[at + shortest : at + FRAME + longest], FRAME)
        alike = later @ frame / np.sqrt(power * (later**2).sum(axis=1) + 1e-9)
        best = float(alike.max())
        if best > PERIODIC:
            first = int(np.flatnonzero(alike > 0.9 * best)[0])  # not a multiple of the period
            while first + 1 < len(alike) and alike[first + 1] > alike[first]:
                first += 1
            found.append(IN_RATE / (first + shortest))
    return float(np.median(found)) if len(found) >= ENOUGH else None


def is_another(first: Samples, second: Samples) -> bool:
    """Return whether two sounds are the voices of two people, as far as their pitches tell."""
    one, other = pitch(first), pitch(second)
    return one is not None and other is not None and max(one, other) > ANOTHER * min(one, other)
