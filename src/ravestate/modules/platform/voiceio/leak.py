"""The part of the agent's voice that stays in the microphone's sound. Only louder sound counts as another voice."""

from __future__ import annotations

from collections import deque

import numpy as np
from numpy.typing import NDArray

from .echo import FRAME
from .likeness import FAR, NEAR, likeness, strength
from .sound import Samples

MEMORY = 16
"""The number of last frames of the loudspeaker's sound that may still echo: 0.3 s."""
SILENT = 100.0
"""The power of a frame below which the loudspeaker is silent."""
FIRST = 10 ** (-13 / 10)
"""The share of the loudspeaker's power to expect at first, before the canceller has learnt the room."""
LEAST, MOST = 1e-6, 0.25
CLEAR = 10.0
"""The factor above the expected power at which the sound is another voice: 10 dB."""
DOWN, UP, SLOWLY = 10 ** (-0.03), 10**0.09, 10**0.01
"""The factors by which a chunk changes the expected share: for less power than expected, for more, and for another
voice."""

SETTLED = 15
"""The number of frames with sound on both sides after which the measured strength of the echo counts: 0.3 s."""
SMOOTH = 0.3
"""The weight of a new measurement in the mean strength."""
MARGIN = 10 ** (4 / 10)
"""The factor by which an echo may exceed its measured strength, which does not include late reflections."""

ALIKE = 25.0
"""The `likeness` above which the microphone hears the loudspeaker."""
TWICE = 2
"""The number of comparisons in a row that prove an echo. For a moment, two voices may be alike by chance."""
DOUBTFUL = 12
"""The number of frames with sound on both sides, but no echo, after which a line counts as free of echo: 0.24 s."""
QUIET = 0.25
"""The weight of a frame in which the microphone is silent: an echo may be late."""
OFTEN, SELDOM = 2, 8
"""The frames between two comparisons before and after the first decision. A comparison takes a few milliseconds."""
GONE = 250
"""The same as `DOUBTFUL`, for a line that had an echo: 5 s. Somebody may speak louder than the echo."""


class Leak:
    """The expected share of the loudspeaker's power in the cleaned sound of the microphone.

    On a line without echo (headphones, a recording), no sound counts as the agent's. The likeness of the two sounds
    shows whether a line has an echo. Their levels do not, because a user who speaks may be as loud as an echo.
    """

    def __init__(self) -> None:
        self.share = FIRST
        """The expected share of the loudspeaker's power in the cleaned sound."""
        self._far: deque[float] = deque(maxlen=MEMORY)  # the power of the loudspeaker's last frames
        self._near_sound: NDArray[np.float32] = np.zeros(NEAR, np.float32)
        self._far_sound: NDArray[np.float32] = np.zeros(FAR, np.float32)
        self._strength: float | None = None  # the measured strength of the echo before cleaning
        self._unlike = 0.0  # the (weighted) number of frames without an echo since the last echo
        self._limit = DOUBTFUL  # the number of such frames after which the line counts as free of echo
        self._frame = 0  # the number of frames with sound on both sides
        self._alike = 0  # the number of comparisons in a row that found an echo
        self.echoes = False
        """Whether an echo has been found, so that the microphone's sound needs cleaning."""

    @property
    def possible(self) -> bool:
        """Whether there is an echo, or it is too early to tell."""
        return self._unlike < self._limit

    def play(self, near: Samples, far: Samples) -> None:
        """Note a frame of the microphone's sound before cleaning, and the frame of the loudspeaker's sound."""
        self._far.append(_power(far))
        self._near_sound = _shifted(self._near_sound, near)
        self._far_sound = _shifted(self._far_sound, far)
        if max(self._far) < SILENT:
            return
        if _power(near) < SILENT:
            self._unlike += QUIET
            return
        self._unlike += 1
        self._frame += 1
        every = OFTEN if self._limit == DOUBTFUL else SELDOM
        if self._frame % every == 0:
            alike, delay = likeness(self._near_sound, self._far_sound)
            self._alike = self._alike + 1 if alike > ALIKE else 0
            if alike > ALIKE:
                found = strength(self._near_sound, self._far_sound, delay)
                old = found if self._strength is None else self._strength
                self._strength = old + SMOOTH * (found - old)
        if self._alike >= TWICE:
            self.echoes = True
            self._unlike, self._limit = 0, GONE
        elif not self.possible:
            self.echoes, self._limit = False, 0

    def hides(self, near: Samples) -> bool:
        """Return whether a chunk of the microphone's cleaned sound may be the loudspeaker's. Learn from the chunk."""
        far = max(self._far, default=0.0)
        if far < SILENT or not self.possible:
            return False
        if not self.echoes:
            return True
        ratio = _power(near) / far
        hidden = ratio < min(CLEAR * self.share, self._loudest)
        step = DOWN if ratio < self.share else UP if hidden else SLOWLY
        self.share = min(MOST, max(LEAST, self.share * step))
        return hidden

    @property
    def _loudest(self) -> float:
        """The greatest share that an echo can have. A user who speaks from the first moment does not increase it."""
        if self._strength is None or self._frame < SETTLED:
            return CLEAR * MOST
        return MARGIN * self._strength


def _shifted(sound: NDArray[np.float32], frame: Samples) -> NDArray[np.float32]:
    return np.concatenate([sound[FRAME:], frame.astype(np.float32)])


def _power(sound: Samples) -> float:
    return float(np.mean(sound.astype(np.float64) ** 2)) if len(sound) else 0.0
