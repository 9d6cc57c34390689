"""The pitch of speech shows whether one person or two people speak."""

from pathlib import Path

import numpy as np
import pytest

from modules.platform.voiceio.speech import PEOPLE, noise, spoken
from ravestate.modules.platform.voiceio import sound
from ravestate.modules.platform.voiceio.pitch import change, is_another, pitch, pitches


@pytest.mark.parametrize("hertz", [90.0, 140.0, 220.0, 330.0])
def test_the_function_pitch_returns_the_frequency_of_a_tone(hertz: float) -> None:
    time = np.arange(16000) / 16000
    tone = sum(np.sin(2 * np.pi * hertz * k * time) / k for k in range(1, 8)) * 4000
    assert pitch(tone.astype("<i2")) == pytest.approx(hertz, rel=0.03)


def test_noise_and_silence_have_no_pitch() -> None:
    assert not any(pitches(sound.samples(noise(1.0, 3000))))
    assert not any(pitches(np.zeros(16000, np.int16)))


def voice(text: str, name: str) -> list[float | None]:
    return pitches(sound.samples(spoken(text, name)))


def test_a_low_and_a_high_voice_count_as_two_people() -> None:
    low = [voice(text, "espeak:en-us") for text in ("I would like to go to", "Not today, thank you.")]
    high = voice("No, that is too far.", "espeak:en+f3")
    assert is_another(low[0], high) and is_another(high, low[1])
    assert not is_another(*low)


def test_two_parts_of_one_persons_speech_count_as_one_person() -> None:
    pcm = sound.samples(sound.decode(PEOPLE / "librivox" / "sense_and_sensibility_01_austen_64kb-0870.wav", 16000))
    assert not is_another(pitches(pcm[: len(pcm) // 2]), pitches(pcm[len(pcm) // 2 :]))


def test_the_function_change_finds_the_place_where_another_person_begins_to_speak() -> None:
    low = voice("I would like to go to the station.", "espeak:en-us")
    high = voice("No, that is much too far for us.", "espeak:en+f3")
    for first, second in ((low, high), (high, low)):
        place = change([*first, *second])
        assert place is not None and abs(place - len(first)) < 6
    assert change([*low, *low]) is None


@pytest.mark.parametrize("file", sorted((PEOPLE / "librivox").glob("*.wav")), ids=lambda file: file.stem[-9:])
def test_a_reader_whose_pitch_varies_counts_as_one_person(file: Path) -> None:
    found = pitches(sound.samples(sound.decode(file, 16000)), 512)
    assert all(change(found[at : at + 250]) is None for at in range(0, len(found), 60))
