"""The part of the agent's voice that stays in the microphone's sound, and the level at which somebody else must speak."""

from __future__ import annotations

from collections import deque

import numpy as np

from .sound import Samples

MEMORY = 16
"""Frames of the loudspeaker's sound that may still echo: 0.3 s."""
SILENT = 100.0
"""The power of a frame below which the loudspeaker is silent."""
FIRST = 10 ** (-13 / 10)
"""The part that is expected in the beginning: the canceller has not learnt the room yet."""
LEAST, MOST = 1e-6, 0.25
CLEAR = 10.0
"""The factor above the expected power at which it is another voice: 10 dB."""
DOWN, UP, SLOWLY = 10 ** (-0.03), 10**0.09, 10**0.01
"""The factors by which a chunk changes the expected share: less power than expected, more, another voice."""


class Leak:
    """The expected share of the loudspeaker's power in the cleaned sound of the microphone."""

    def __init__(self) -> None:
        self.share = FIRST
        self._far: deque[float] = deque(maxlen=MEMORY)

    def play(self, far: Samples) -> None:
        """Note a frame of the loudspeaker's sound."""
        self._far.append(_power(far))

    def hides(self, near: Samples) -> bool:
        """Return whether a chunk of the microphone's cleaned sound may be the loudspeaker's, and learn from it."""
        far = max(self._far, default=0.0)
        if far < SILENT:
            return False
        ratio = _power(near) / far
        hidden = ratio < CLEAR * self.share
        step = DOWN if ratio < self.share else UP if hidden else SLOWLY
        self.share = min(MOST, max(LEAST, self.share * step))
        return hidden


def _power(sound: Samples) -> float:
    return float(np.mean(sound.astype(np.float64) ** 2)) if len(sound) else 0.0
