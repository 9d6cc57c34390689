"""Two voices are told apart by their pitch; one person stays one."""

import numpy as np
import pytest

from modules.platform.voiceio.speech import PEOPLE, noise, spoken
from ravestate.modules.platform.voiceio import sound
from ravestate.modules.platform.voiceio.pitch import is_another, pitch


@pytest.mark.parametrize("hertz", [90.0, 140.0, 220.0, 330.0])
def test_a_tone_has_its_pitch(hertz: float) -> None:
    time = np.arange(16000) / 16000
    tone = sum(np.sin(2 * np.pi * hertz * k * time) / k for k in range(1, 8)) * 4000
    assert pitch(tone.astype("<i2")) == pytest.approx(hertz, rel=0.03)


def test_noise_and_silence_have_none() -> None:
    assert pitch(sound.samples(noise(1.0, 3000))) is None
    assert pitch(np.zeros(16000, np.int16)) is None


def test_a_low_and_a_high_voice_are_two_people() -> None:
    low = [sound.samples(spoken(text, "espeak:en-us")) for text in ("I would like to go to", "Not today, thank you.")]
    high = sound.samples(spoken("No, that is too far.", "espeak:en+f3"))
    assert is_another(low[0], high) and is_another(high, low[1])
    assert not is_another(*low)


def test_a_person_is_one() -> None:
    pcm = sound.samples(sound.decode(PEOPLE / "librivox" / "sense_and_sensibility_01_austen_64kb-0870.wav", 16000))
    assert not is_another(pcm[: len(pcm) // 2], pcm[len(pcm) // 2 :])
