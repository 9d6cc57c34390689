"""Opening a conversation: the parts that a line needs, and what is closed with it."""

import asyncio
import gc
import threading
from typing import cast

import pytest

from modules.platform.voiceio.speech import FAST, Scripted
from modules.platform.voiceio.test_wav_line import run
from ravestate.errors import PlatformError
from ravestate.modules.platform.voiceio import Settings, opening
from ravestate.modules.platform.voiceio.ear import Turn
from ravestate.modules.platform.voiceio.echo import EchoCanceller
from ravestate.modules.platform.voiceio.turn import Melody
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


def test_words_that_nobody_waits_for_any_more_may_fail_quietly(monkeypatch: pytest.MonkeyPatch) -> None:
    """At Ctrl-C, the process of the model is killed in the middle of its work."""
    failures: list[object] = []
    judging = threading.Event()

    class Slow:
        def complete(self, pcm: bytes) -> float:
            assert judging.wait(10)
            return 1.0

    async def talk() -> None:
        asyncio.get_running_loop().set_exception_handler(lambda _, what: failures.append(what))
        conversation = await opening.open_conversation(WavLine(None), Settings(**FAST["voiceio"]), pytest.fail)
        conversation.melody = cast(Melody, Slow())
        rule = asyncio.create_task(conversation.judge(Turn(0.0, 1.0)))
        while not heard.heard:  # noqa: ASYNC110  # a thread sets it
            await asyncio.sleep(0)
        rule.cancel()
        judging.set()
        await asyncio.wait([rule])
        del rule
        conversation.close()
        for _ in range(3):
            await asyncio.sleep(0)
        gc.collect()

    heard = Scripted(PlatformError("voiceio: the process of whisper ended (killed by signal 9)"))
    monkeypatch.setattr(opening, "Recogniser", heard)
    run(talk)
    assert not failures
