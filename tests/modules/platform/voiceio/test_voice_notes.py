"""A voice note is made from a text as an OGG file. The recogniser finds the same words in this file."""

from pathlib import Path

import pytest

from modules.platform.voiceio.speech import noise, wav, word_errors
from ravestate.errors import PlatformError
from ravestate.modules import voiceio

TINY = voiceio.Settings(model="tiny.en", voice="piper")
TEXT = "It was a bright cold day in April, and the clocks were striking."


def test_the_words_of_a_synthesised_note_are_recognised(tmp_path: Path) -> None:
    note = voiceio.synthesise(TEXT, TINY)
    assert note[:4] == b"OggS"
    found = voiceio.transcribe(note, TINY)
    assert word_errors(TEXT, found.text) <= 1
    assert found.confidence > 0.6 and 0 <= found.start < 0.5 < 3.0 < found.end
    (tmp_path / "note.ogg").write_bytes(note)
    assert voiceio.transcribe(tmp_path / "note.ogg", TINY) == found


def test_a_note_without_speech_has_no_words(tmp_path: Path) -> None:
    found = voiceio.transcribe(wav(tmp_path / "hiss.wav", noise(2.0, 800)), TINY)
    assert (found.text, found.confidence) == ("", 0.0)


def test_a_text_without_words_cannot_be_spoken() -> None:
    with pytest.raises(PlatformError, match="no words to speak"):
        voiceio.synthesise("😊 …", TINY)


def test_a_damaged_note_is_refused() -> None:
    with pytest.raises(PlatformError, match="cannot read the sound of 9 bytes"):
        voiceio.transcribe(b"not sound", TINY)


def test_settings_come_from_the_environment(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("RAVESTATE_VOICEIO_MODEL", "none")
    with pytest.raises(PlatformError, match="no model 'none'"):
        voiceio.transcribe(voiceio.synthesise("Hello there.", TINY))
