"""Voice notes with the real recogniser and voice. Without the speech packages, an error says what to install."""

import asyncio
import sys
from pathlib import Path

import pytest

from modules.platform.chats.messenger import Post, letter, room
from modules.platform.webio.visit import in_virtual_time
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


def test_an_answer_whose_words_do_not_fit_below_one_voice_note_is_sent_in_several(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    text = " ".join(["word"] * 25)

    async def instead(*_: object) -> str:
        return text

    async def sound(words: str) -> bytes:
        return words.encode()

    monkeypatch.setattr("ravestate.modules.platform.chats.chat.words_in", instead)
    monkeypatch.setattr("ravestate.modules.platform.chats.voice.spoken", sound)

    @in_virtual_time
    async def test() -> None:
        post = Post()
        post.files["1"] = b"note"
        async with room(tmp_path, post) as opened:
            opened.receive([letter(kind="voice", file="1")])
            await post.said(4)
        notes = post.sent[1:]
        assert [(note.kind, note.data) for note in notes] == [("voice", note.text.encode()) for note in notes]
        assert all(len(note.text) <= post.longest_caption for note in notes)
        assert " ".join(note.text for note in notes) == text

    test()
