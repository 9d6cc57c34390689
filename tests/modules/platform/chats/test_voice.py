"""Voice notes with the real recogniser and voice. Without the speech packages, an error says what to install."""

import asyncio
import sys

import pytest

from ravestate.errors import PlatformError
from ravestate.modules.platform.chats.voice import VOICE, spoken, words_in


def test_the_recogniser_understands_a_text_that_the_voice_has_spoken() -> None:
    async def there_and_back() -> str:
        note = await spoken("Hello, how are you today?")
        assert note is not None
        assert note.startswith(b"OggS")
        return await words_in(note)

    assert "how are you" in asyncio.run(there_and_back()).lower()


def test_a_damaged_note_is_refused() -> None:
    with pytest.raises(PlatformError):
        asyncio.run(words_in(b"no sound at all"))


def test_without_the_speech_packages_the_error_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, VOICE, None)
    assert asyncio.run(spoken("Hello")) is None
    with pytest.raises(PlatformError, match=r"pip install 'ravestate\[voice\]'"):
        asyncio.run(words_in(b""))
