"""Sounds can be read, resampled, written and cut into pieces. Bad files are refused with a reason."""

from pathlib import Path

import numpy as np
import pytest

from ravestate.errors import PlatformError
from ravestate.modules.platform.voiceio import sound


def tone(rate: int, hertz: float = 440.0, length: float = 0.5) -> bytes:
    return (8000 * np.sin(2 * np.pi * hertz * np.arange(int(rate * length)) / rate)).astype("<i2").tobytes()


@pytest.mark.parametrize(("old", "new"), [(24000, 16000), (22050, 24000), (48000, 16000), (16000, 16000)])
def test_resampling_keeps_length_and_pitch(old: int, new: int) -> None:
    found = sound.samples(sound.resample(tone(old), old, new)).astype(float)
    assert len(found) / new == pytest.approx(0.5, abs=0.005)
    peak = np.argmax(np.abs(np.fft.rfft(found))) * new / len(found)
    assert peak == pytest.approx(440, abs=4)


def test_an_ogg_file_can_be_written_and_read(tmp_path: Path) -> None:
    pcm = tone(24000, length=1.0)
    encoded = sound.encode_ogg(pcm, 24000)
    assert encoded[:4] == b"OggS" and b"OpusHead" in encoded[:100]
    assert len(encoded) < len(pcm) / 4
    back = sound.decode(encoded, 16000)
    assert sound.seconds(back, 16000) == pytest.approx(1.0, abs=0.05)
    spectrum = np.abs(np.fft.rfft(sound.samples(back).astype(float)))
    assert np.argmax(spectrum) * 16000 / (len(back) / 2) == pytest.approx(440, abs=4)


def test_stereo_sound_is_mixed_to_mono(tmp_path: Path) -> None:
    import wave

    left = sound.samples(tone(16000)).reshape(-1, 1)
    with wave.open(str(tmp_path / "stereo.wav"), "wb") as file:
        file.setnchannels(2)
        file.setsampwidth(2)
        file.setframerate(16000)
        file.writeframes(np.hstack([left, left]).astype("<i2").tobytes())
    assert sound.seconds(sound.decode(tmp_path / "stereo.wav", 16000), 16000) == pytest.approx(0.5, abs=0.01)


def test_the_beginning_of_a_truncated_file_can_be_read(tmp_path: Path) -> None:
    encoded = sound.encode_ogg(tone(24000, length=4.0), 24000)
    assert 0.5 < sound.seconds(sound.decode(encoded[: len(encoded) // 2], 16000), 16000) < 4.0


@pytest.mark.parametrize("content", [b"", b"no sound at all", b"RIFF\x00\x00\x00\x00WAVEfmt "])
def test_a_bad_file_is_refused(content: bytes, tmp_path: Path) -> None:
    file = tmp_path / "bad.wav"
    file.write_bytes(content)
    with pytest.raises(PlatformError, match="cannot read the sound of"):
        sound.decode(file, 16000)
    with pytest.raises(PlatformError, match="cannot read the sound of"):
        sound.decode(content, 16000)


def test_a_missing_file_is_refused(tmp_path: Path) -> None:
    with pytest.raises(PlatformError, match=r"none\.wav"):
        sound.decode(tmp_path / "none.wav", 16000)


def test_a_folder_that_cannot_be_written_is_refused(tmp_path: Path) -> None:
    with pytest.raises(PlatformError, match="cannot write"):
        sound.write_wav(tmp_path / "none" / "out.wav", bytes(100), 16000)


def test_a_long_sound_is_cut_at_quiet_moments() -> None:
    loud = np.random.default_rng(0).normal(0, 3000, 16000 * 70).astype("<i2")
    for second in (10, 24, 45):  # three quiet moments; a cut at the first would be too early
        loud[16000 * second : 16000 * second + 6400] //= 50
    found = list(sound.pieces(loud.tobytes(), 16000, 28.0))
    assert b"".join(found) == loud.tobytes()
    lengths = [len(piece) / 32000 for piece in found]
    assert lengths[:2] == [pytest.approx(24.2, abs=0.1), pytest.approx(21.0, abs=0.1)] and max(lengths) <= 28.0
    assert list(sound.pieces(b"\1\1" * 100, 16000, 28.0)) == [b"\1\1" * 100]
    assert max(len(piece) for piece in sound.pieces(bytes(32000 * 600), 16000, 28.0)) <= 28 * 32000
