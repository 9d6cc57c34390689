"""Estimate how much of the agent's voice stays in the microphone's sound. Only louder sound counts as another voice.

The *cleaned* sound is the microphone's sound after echo cancellation. A *frame* has 20 ms of sound, a *chunk* 32 ms.
"""

from __future__ import annotations

from collections import deque

import numpy as np
from numpy.typing import NDArray

from .echo import FRAME
from .likeness import FAR, NEAR, likeness, strength
from .sound import Samples

MEMORY = 16
"""This many of the last frames of the loudspeaker's sound (0.3 s) may still echo."""
SILENT = 100.0
"""A frame with less power than this counts as silence."""
FIRST = 10 ** (-13 / 10)
"""The share of the loudspeaker's power that is expected in the cleaned sound at first, before the canceller has adapted
to the room."""
LEAST, MOST = 1e-6, 0.25
"""The smallest and the greatest expected share."""
CLEAR = 10.0
"""Sound with this many times the expected power (10 dB more) is another voice."""
DOWN, UP, SLOWLY = 10 ** (-0.03), 10**0.09, 10**0.01
"""A chunk multiplies the expected share by `DOWN` if it has less power than expected, and by `UP` if it has more. A
chunk of another voice multiplies the share by `SLOWLY`."""

SETTLED = 15
"""The measured strength of the echo is used after this many frames (0.3 s) in which the microphone and the loudspeaker
have sound."""
SMOOTH = 0.3
"""The weight of a new measurement in the mean strength."""
MARGIN = 10 ** (4 / 10)
"""An echo may be this many times stronger than measured, because the measurement misses late reflections."""

ALIKE = 25.0
"""If the `likeness` of their sounds is greater than this, the microphone hears the loudspeaker."""
TWICE = 2
"""This many comparisons in a row prove an echo. One comparison may find two voices alike by chance."""
DOUBTFUL = 12
"""A line counts as free of echo after this many frames (0.24 s) in which microphone and loudspeaker have sound, but no
echo is found."""
QUIET = 0.25
"""A frame in which the microphone is silent counts as only this part of a frame towards `DOUBTFUL`, because an echo may
be late."""
OFTEN, SELDOM = 2, 8
"""The two sounds are compared once in `OFTEN` frames until it is decided whether there is an echo. After that, they are
compared once in `SELDOM` frames. A comparison takes milliseconds."""
GONE = 250
"""The number of frames (5 s) that replaces `DOUBTFUL` on a line that has had an echo. It is greater, because a person
may speak so loudly that no echo is found."""


class Leak:
    """Estimates which share of the loudspeaker's power stays in the cleaned sound of the microphone.

    On a line (microphone and loudspeaker) without echo, for example with headphones, no sound counts as the agent's.
    The likeness of the two sounds shows whether a line has an echo. Their levels do not show it, because a user may
    speak as loudly as an echo.
    """

    def __init__(self) -> None:
        self.share = FIRST
        """The expected share of the loudspeaker's power in the cleaned sound."""
        self._far: deque[float] = deque(maxlen=MEMORY)  # the power of the loudspeaker's last frames
        self._near_sound: NDArray[np.float32] = np.zeros(NEAR, np.float32)
        self._far_sound: NDArray[np.float32] = np.zeros(FAR, np.float32)
        self._strength: float | None = None  # the measured strength of the echo before cleaning
        self._unlike = 0.0  # how many frames (weighted) came since the last echo
        self._limit = DOUBTFUL  # after this many such frames, the line counts as free of echo
        self._frame = 0  # in how many frames the microphone and the loudspeaker had sound
        self._alike = 0  # how many comparisons in a row have found an echo
        self.echoes = False
        """Whether an echo has been found. If so, the microphone's sound needs cleaning."""

    @property
    def possible(self) -> bool:
        """Whether there is an echo, or it is too early to tell."""
        return self._unlike < self._limit

    def play(self, near: Samples, far: Samples) -> None:
        """Note a frame of the microphone's sound before cleaning, and the loudspeaker's frame at the same time."""
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
        """Return whether a chunk of the microphone's cleaned sound may come from the loudspeaker. Adapt `share`."""
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
        """The greatest possible share of an echo, from its measured strength. The user's speech does not raise it."""
        if self._strength is None or self._frame < SETTLED:
            return CLEAR * MOST
        return MARGIN * self._strength


def _shifted(sound: NDArray[np.float32], frame: Samples) -> NDArray[np.float32]:
    return np.concatenate([sound[FRAME:], frame.astype(np.float32)])


def _power(sound: Samples) -> float:
    return float(np.mean(sound.astype(np.float64) ** 2)) if len(sound) else 0.0
