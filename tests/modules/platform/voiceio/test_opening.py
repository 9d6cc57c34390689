"""Opening a conversation: the parts that a line needs, and what is closed with it."""

import pytest

from modules.platform.voiceio.speech import FAST, Scripted
from modules.platform.voiceio.test_wav_line import run
from ravestate.errors import PlatformError
from ravestate.modules.platform.voiceio import Settings, opening
from ravestate.modules.platform.voiceio.echo import EchoCanceller
from ravestate.modules.platform.voiceio.wav_line import WavLine
from ravestate.modules.platform.webio.line import PageLine


def open_and_close(line: WavLine | PageLine, monkeypatch: pytest.MonkeyPatch) -> list[EchoCanceller]:
    """Return the cancellers that a conversation made; all are freed."""
    made: list[EchoCanceller] = []

    def make() -> EchoCanceller:
        made.append(EchoCanceller())
        return made[-1]

    async def talk() -> None:
        conversation = await opening.open_conversation(line, Settings(**FAST["voiceio"]), pytest.fail)
        conversation.close()

    monkeypatch.setattr(opening, "Recogniser", Scripted("Hello."))
    monkeypatch.setattr(opening, "EchoCanceller", make)
    run(talk)
    assert not any(one._echo for one in made)
    return made


def test_the_echo_is_removed_where_the_line_does_not_do_it(monkeypatch: pytest.MonkeyPatch) -> None:
    assert len(open_and_close(WavLine(None), monkeypatch)) == 1


def test_a_browser_removes_the_echo_itself(monkeypatch: pytest.MonkeyPatch) -> None:
    assert open_and_close(PageLine(), monkeypatch) == []


def test_a_device_is_closed_again_if_a_later_part_is_missing(monkeypatch: pytest.MonkeyPatch) -> None:
    line = WavLine(None)

    def fail(*_: object) -> None:
        raise PlatformError("no model of voice activity")

    monkeypatch.setattr(opening, "Recogniser", Scripted("Hello."))
    monkeypatch.setattr(opening, "_device", lambda _: line)
    monkeypatch.setattr(opening, "Ear", fail)

    async def talk() -> None:
        with pytest.raises(PlatformError, match="voice activity"):
            await opening.open_conversation(None, Settings(**FAST["voiceio"]), pytest.fail)
        assert [block async for block in line.blocks()] == []

    run(talk)
