"""`likeness` finds an echo of the loudspeaker's sound, but does not take another voice for an echo."""

import numpy as np
import pytest

from modules.platform.voiceio.speech import spoken, track
from ravestate.modules.platform.voiceio.likeness import FAR, NEAR, likeness, strength

FAR_TEXT, NEAR_TEXT = "Once there was a robot in a museum.", "The mountains, and my grandmother."


def sound(*parts: tuple[float, str | bytes]) -> np.ndarray:
    return np.frombuffer(track(*parts, length=4.0), "<i2").astype(np.float32)


def test_an_echo_is_found_at_any_level_and_delay() -> None:
    far = sound((0.1, FAR_TEXT))[:FAR]
    for level, delay in ((0.3, 480), (0.01, 480), (0.3, 0), (0.3, 12000)):
        near = level * np.concatenate([np.zeros(delay, np.float32), far])[FAR - NEAR : FAR]
        peak, found = likeness(near.astype(np.float32), far)
        assert peak > 50 and abs(found - delay) < 3, (level, delay)


@pytest.mark.parametrize("name", ["piper", "espeak:en-us"])
def test_another_voice_is_not_an_echo_even_if_it_begins_at_the_same_time(name: str) -> None:
    far, near = sound((1.0, FAR_TEXT)), sound((1.0, spoken(NEAR_TEXT, name)))
    for end in range(FAR, FAR + 8000, 1280):
        assert likeness(near[end - NEAR : end], far[end - FAR : end])[0] < 25


def test_silence_is_not_an_echo() -> None:
    assert likeness(np.zeros(NEAR, np.float32), sound((0.1, FAR_TEXT))[:FAR])[0] < 25


def test_the_function_strength_measures_an_echo_even_while_the_user_speaks() -> None:
    far, user = sound((0.1, FAR_TEXT))[:FAR], sound((0.8, spoken(NEAR_TEXT, "espeak:en-us")))[FAR - NEAR : FAR]
    for decibels in (-5.0, -10.0):
        echo = 10 ** (decibels / 20) * np.concatenate([np.zeros(480, np.float32), far])[FAR - NEAR : FAR]
        for near in (echo, echo + user):
            found = 10 * np.log10(strength(near.astype(np.float32), far, 480))
            assert abs(found - decibels) < 4, (decibels, found)
