"""A voice turns text into sound, with the time of each word and a prosody. Missing voices are reported."""

import itertools

import pytest

from modules.platform.voiceio.speech import voice
from ravestate.errors import PlatformError
from ravestate.modules.platform.voiceio import Prosody, Settings, models
from ravestate.modules.platform.voiceio.synthesiser import Synthesiser

TEXT = "Once upon a time there was a robot with 25 friends."


@pytest.mark.parametrize("name", ["espeak", "piper"])
def test_each_word_has_a_time_in_the_sound(name: str) -> None:
    spoken = voice(name).speak(TEXT)
    length = len(spoken.sound) / 48000
    assert 2.0 < length < 6.0
    assert len(spoken.reference) / 32000 == pytest.approx(length, abs=0.02)
    assert [TEXT[word.begin : word.end] for word in spoken.words] == TEXT.split()
    times = [word.time for word in spoken.words]
    assert times == sorted(times) and times[0] < 0.3 and length - times[-1] > 0.2
    assert all(later - earlier > 0.03 for earlier, later in itertools.pairwise(times))
    assert times[9] + 0.3 < times[10]  # a spoken number takes long


@pytest.mark.parametrize("name", ["espeak", "piper"])
def test_prosody_changes_the_speed(name: str) -> None:
    normal, slow = (len(voice(name).speak(TEXT, Prosody(rate=rate)).sound) for rate in (1.0, 0.7))
    assert slow > 1.15 * normal


@pytest.mark.parametrize("name", ["espeak", "piper"])
@pytest.mark.parametrize("factor", [0.25, 4.0])
def test_a_voice_can_speak_in_every_manner(name: str, factor: float) -> None:
    assert len(voice(name).speak("Oh, hello!", Prosody(factor, factor, factor)).sound) > 4800


@pytest.mark.parametrize("value", [0.0, -1.0, 0.2, 5.0, float("nan"), float("inf")])
def test_a_manner_that_no_voice_has_is_refused(value: float) -> None:
    """Otherwise, the voice would fail at each sentence, or take too long."""
    with pytest.raises(ValueError, match=rf"rate of a Prosody must be from 0\.25 to 4, not {value}"):
        Prosody(rate=value)
    for name in ("pitch", "range"):
        with pytest.raises(ValueError, match=f"{name} of a Prosody must be from 0 to 4, not -1"):
            Prosody(**{name: -1.0})


def test_prosody_changes_the_pitch_of_espeak() -> None:
    low, high = (voice("espeak").speak("Oh!", Prosody(pitch=pitch)).sound for pitch in (0.8, 1.3))
    assert low != high


def test_the_error_names_a_missing_voice() -> None:
    with pytest.raises(PlatformError, match="has no voice 'en_US-nobody'"):
        Synthesiser(Settings(voice="en_US-nobody"))
    nobody = Synthesiser(Settings(voice="espeak:xx-none"))
    with pytest.raises(PlatformError, match=r"has no voice 'xx-none': .* voiceio\.voice"):
        nobody.load()
    nobody.close()


@pytest.mark.parametrize("language", ["de-AT", "zh"])
def test_espeak_falls_back_to_the_voice_that_is_nearest_to_the_language(language: str) -> None:
    """It has no voice for Austria, and the name of its Chinese voice is not ``zh``."""
    near = Synthesiser(Settings(voice="espeak", language=language))
    near.load()
    near.close()


def test_without_piper_the_default_voice_is_espeak(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("ravestate.modules.platform.voiceio.synthesiser.piper_python", lambda _: None)
    light = Synthesiser(Settings(voice=""))
    assert light.name == "espeak:en"
    light.close()
    with pytest.raises(PlatformError, match="needs Piper"):
        Synthesiser(Settings(voice="piper"))


def test_a_piper_voice_is_found_by_name_and_by_file() -> None:
    file = models.piper_voice("en_US-joe-medium")
    assert file is not None and models.piper_voice(str(file)) == file == models.piper_voice("")
    assert models.piper_voice("none") is None
