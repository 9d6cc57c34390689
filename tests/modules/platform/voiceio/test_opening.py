"""A spoken conversation opens and closes all its parts, and judges the sound that it hears."""

import asyncio
import gc
import threading
from pathlib import Path
from typing import Any, cast

import pytest

from modules.platform.voiceio.speech import FAST, Scripted, wav
from modules.platform.voiceio.test_wav_line import run
from ravestate.errors import PlatformError
from ravestate.modules._children import process
from ravestate.modules.platform.voiceio import Settings, device_line, opening, sound
from ravestate.modules.platform.voiceio.ear import Turn
from ravestate.modules.platform.voiceio.echo import EchoCanceller
from ravestate.modules.platform.voiceio.recogniser import Recognised
from ravestate.modules.platform.voiceio.turn import Melody
from ravestate.modules.platform.voiceio.wav_line import WavLine
from ravestate.modules.platform.webio.line import PageLine


def open_and_close(line: WavLine | PageLine, monkeypatch: pytest.MonkeyPatch) -> list[EchoCanceller]:
    """Open and close a conversation. Return its echo cancellers, and check that they are closed."""
    made: list[EchoCanceller] = []
    closed: list[EchoCanceller] = []

    class Noted(EchoCanceller):
        def __init__(self) -> None:
            super().__init__()
            made.append(self)

        def close(self) -> None:
            super().close()
            closed.append(self)

    async def talk() -> None:
        conversation = await opening.open_conversation(line, Settings(**FAST["voiceio"]), pytest.fail)
        conversation.close()

    monkeypatch.setattr(opening, "Recogniser", Scripted("Hello."))
    monkeypatch.setattr(opening, "EchoCanceller", Noted)
    run(talk)
    assert closed == made
    return made


def test_a_conversation_has_an_echo_canceller_if_its_line_has_none(monkeypatch: pytest.MonkeyPatch) -> None:
    assert len(open_and_close(WavLine(None), monkeypatch)) == 1


def test_a_conversation_on_a_page_has_no_echo_canceller_because_browsers_have_one(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    assert open_and_close(PageLine(), monkeypatch) == []


def test_the_line_is_closed_if_a_part_that_is_opened_later_is_missing(monkeypatch: pytest.MonkeyPatch) -> None:
    line = WavLine(None)

    def fail(*_: object) -> None:
        raise PlatformError("no model of voice activity")

    monkeypatch.setattr(opening, "Recogniser", Scripted("Hello."))

    async def opened(_: Settings) -> WavLine:
        return line

    monkeypatch.setattr(opening, "open_line", opened)
    monkeypatch.setattr(opening, "Ear", fail)

    async def talk() -> None:
        with pytest.raises(PlatformError, match="voice activity"):
            await opening.open_conversation(None, Settings(**FAST["voiceio"]), pytest.fail)
        assert [block async for block in line.blocks()] == []

    run(talk)


def test_all_parts_are_closed_if_the_sound_cannot_be_written(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    closed: list[str] = []
    scripted = Scripted("Hello.")
    monkeypatch.setattr(scripted, "close", lambda **_: closed.append("recogniser"))
    monkeypatch.setattr(opening, "Recogniser", scripted)

    async def talk() -> None:
        line = WavLine(None, tmp_path / "out.wav")
        line.begin()
        conversation = await opening.open_conversation(line, Settings(**FAST["voiceio"]), pytest.fail)
        monkeypatch.setattr(conversation.mouth.voice, "close", lambda **_: closed.append("voice"))
        (tmp_path / "out.wav").unlink()
        (tmp_path / "out.wav").mkdir()
        with pytest.raises(PlatformError, match="cannot write"):
            conversation.close()

    run(talk)
    assert closed == ["recogniser", "voice"]


def test_recognition_of_a_turn_is_cancelled_when_the_user_continues_the_turn(monkeypatch: pytest.MonkeyPatch) -> None:
    """The user continues while the recogniser works on the first part. Then the conversation cancels its call of `judge`,
    the method that runs the recogniser."""
    scripted, begun, asked = Scripted("Hello."), threading.Event(), list[threading.Event]()

    def recognise(_: bytes, *, partial: bool = False, unwanted: threading.Event) -> Recognised:
        asked.append(unwanted)
        begun.set()
        assert unwanted.wait(20.0)
        return Recognised("", 0.0)

    monkeypatch.setattr(scripted, "recognise", recognise)
    monkeypatch.setattr(opening, "Recogniser", scripted)

    async def talk() -> None:
        conversation = await opening.open_conversation(WavLine(None), Settings(**FAST["voiceio"]), pytest.fail)
        judging = asyncio.create_task(conversation.judge(Turn(0.0, 1.0, chunks=[bytes(32000)])))
        await asyncio.to_thread(begun.wait)
        judging.cancel()
        await asyncio.wait([judging])
        assert judging.cancelled() and asked[0].is_set()
        conversation.close()

    asyncio.run(talk())


@pytest.mark.parametrize("name", ["Recogniser", "Synthesiser"])
def test_a_line_that_closes_while_its_models_open_leaves_no_user_of_a_model(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    settings = Settings(**{**FAST["voiceio"], "voice": "espeak:en-gb", "threads": 3})  # no other test uses these
    makers, real = (opening.Recogniser, opening.Synthesiser), getattr(opening, name)

    async def talk() -> None:
        loop = asyncio.get_running_loop()

        def cancelled(*args: Any, **options: Any) -> Any:
            loop.call_soon_threadsafe(task.cancel)
            return real(*args, **options)

        monkeypatch.setattr(opening, name, cancelled)
        task = asyncio.create_task(opening.open_conversation(WavLine(None), settings, pytest.fail))  # type: ignore[arg-type]
        await asyncio.wait([task])
        assert task.cancelled()

    asyncio.run(talk())
    for maker in makers:
        one = maker(settings)
        assert not process.is_shared(one.process)
        one.close()


def test_two_conversations_share_the_loaded_model_for_melodies(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(opening, "Recogniser", Scripted("Hello."))

    async def talk() -> None:
        found: list[object] = []
        for _ in range(2):
            conversation = await opening.open_conversation(WavLine(None), Settings(**FAST["voiceio"]), pytest.fail)
            found.append(conversation.melody)
            conversation.close()
        assert found[0] is found[1] is not None

    run(talk)


class Devices(WavLine):
    """A stand-in for a line to audio devices. It keeps their names."""

    def __init__(self, *names: str) -> None:
        super().__init__(None)
        self.names = names


@pytest.mark.parametrize(
    ("source", "sink", "devices", "written"),
    [
        ("in.wav", "default", ("", "default"), False),
        ("default", "out.wav", ("default", ""), True),
        ("default", "", ("default", ""), False),
        ("default", "Headset", ("default", "Headset"), False),
        ("in.wav", "out.wav", None, True),
        ("in.wav", "", None, False),
    ],
)
def test_a_file_and_a_device_can_be_combined(
    source: str,
    sink: str,
    devices: tuple[str, str] | None,
    written: bool,
    monkeypatch: pytest.MonkeyPatch,
    tmp_path: Path,
) -> None:
    opened: list[Devices] = []

    def open_devices(*names: str) -> Devices:
        opened.append(Devices(*names))
        return opened[0]

    monkeypatch.setattr(device_line, "DeviceLine", open_devices)
    monkeypatch.chdir(tmp_path)
    wav(tmp_path / "in.wav", b"\1\1" * 16000)

    async def talk() -> None:
        line = await opening.open_line(Settings(source=source, sink=sink))
        line.play(b"\2\2" * 12000)
        block = await anext(aiter(line.blocks()))
        assert any(block) == (source == "in.wav")
        await line.drained()
        assert line.played == 0.5
        assert bool(opened) == (devices is not None)
        if opened:
            assert opened[0].names == devices
            assert bool(opened[0].played) == (sink in ("default", "Headset"))
        line.close()

    run(talk)
    assert (tmp_path / "out.wav").exists() == written
    if written:
        assert len(sound.decode(tmp_path / "out.wav", 24000)) == 24000


def test_a_recognition_that_fails_after_its_rule_was_cancelled_is_not_reported(monkeypatch: pytest.MonkeyPatch) -> None:
    """Ctrl-C causes such a failure: it kills the model's process while the model works."""
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
        await asyncio.to_thread(heard.begun.wait, 10)
        rule.cancel()
        judging.set()
        await asyncio.wait([rule])
        del rule
        conversation.close()
        gc.collect()

    heard = Scripted(PlatformError("voiceio: the process of whisper ended (killed by signal 9)"))
    monkeypatch.setattr(opening, "Recogniser", heard)
    run(talk)
    assert not failures


@pytest.mark.parametrize(
    ("text", "confidence", "length", "what"),
    [
        ("Amen.", 0.5, 0.3, "false_alarm"),  # a recogniser can mistake a hum for this word
        ("Mm-hmm.", 0.5, 0.5, "back_channel"),
        ("Stop.", 0.5, 0.3, "utterance"),
        ("Why?", 0.8, 0.3, "utterance"),
        ("the mountains and my grandmother", 0.5, 1.8, "utterance"),
    ],
)
def test_a_short_sound_interrupts_only_if_its_words_are_clear_or_mean_stop(
    text: str, confidence: float, length: float, what: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    async def talk() -> None:
        conversation = await opening.open_conversation(WavLine(None), Settings(**FAST["voiceio"]), pytest.fail)
        heard = Recognised(text, confidence)
        assert conversation.verdict(Turn(3.0, 3.0 + length, agent_spoke=True), heard)[0] == what
        assert conversation.verdict(Turn(3.0, 3.0 + length), heard)[0] == "utterance"  # the agent was not speaking
        conversation.close()

    monkeypatch.setattr(opening, "Recogniser", Scripted("Hello."))
    run(talk)
