"""The detector finds the speech of people in sound. It does not take noise, music or silence for speech."""

import numpy as np
import pytest

from modules.platform.voiceio.speech import FOLDER, PEOPLE, noise
from ravestate.modules.platform.voiceio import sound
from ravestate.modules.platform.voiceio.activity import speech_spans


@pytest.mark.parametrize("name", ["librivox/sense_and_sensibility_01_austen_64kb-0880.wav", "cards/001.wav"])
def test_speech_of_people_is_found(name: str) -> None:
    pcm = sound.decode(PEOPLE / name, 16000)
    spans = speech_spans(bytes(16000) + pcm + bytes(16000))
    assert 0.6 * sound.seconds(pcm, 16000) < sum(end - begin for begin, end in spans)
    assert spans[0][0] >= 0.45  # not in the half second of silence before the speech


def music(length: float) -> bytes:
    """Return a sequence of chords of four notes with overtones."""
    time = np.arange(int(length * 16000)) / 16000
    wave = np.zeros(len(time))
    for bar, root in enumerate((220.0, 174.6, 261.6, 196.0)):
        part = (time >= bar * length / 4) & (time < (bar + 1) * length / 4)
        for third in (1.0, 1.26, 1.5, 2.0):
            for overtone in range(1, 5):
                wave += part * np.sin(2 * np.pi * root * third * overtone * time) / overtone**1.5
    return (wave * 2500).astype("<i2").tobytes()


@pytest.mark.parametrize("name", ["silence", "hiss", "loud hiss", "chords", "success", "error"])
def test_no_speech_is_found_in_other_sounds(name: str) -> None:
    pcm = {
        "silence": bytes(64000),
        "hiss": noise(3.0, 300),
        "loud hiss": noise(3.0, 6000),
        "chords": music(4.0),
    }.get(name)
    if pcm is None:
        pcm = sound.decode(FOLDER / "recordings" / f"{name}.wav", 16000)
    assert speech_spans(pcm) == []
