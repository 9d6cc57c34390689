"""A line to audio devices passes blocks of sound. It reopens a device that was unplugged."""

from __future__ import annotations

import asyncio
from typing import Any

import pytest

from modules.platform.voiceio.test_wav_line import run
from ravestate.errors import PlatformError
from ravestate.modules.platform.voiceio import device_line
from ravestate.modules.platform.voiceio.device_line import WAITING, DeviceLine
from ravestate.modules.platform.voiceio.mouth import Mouth
from ravestate.modules.platform.voiceio.synthesiser import Spoken


class PortAudio:
    """A stand-in for sounddevice, with one microphone and one loudspeaker. The tests call their callbacks."""

    class PortAudioError(Exception):
        pass

    def __init__(self) -> None:
        self.microphone: Any = None
        self.loudspeaker: Any = None
        self.broken = ""
        self.restarts = 0

    def _stream(self, rate: int, size: int, **options: Any) -> Any:
        return Stream(self, rate, size, **options)

    def RawInputStream(self, *args: Any, **options: Any) -> Any:
        if self.broken == "microphone":
            raise self.PortAudioError("Error querying device -1")
        self.microphone = self._stream(*args, **options)
        return self.microphone

    def RawOutputStream(self, *args: Any, **options: Any) -> Any:
        if self.broken == "loudspeaker":
            raise ValueError(f"No output device matching {options['device']!r}")
        self.loudspeaker = self._stream(*args, **options)
        return self.loudspeaker

    def _terminate(self) -> None:
        self.restarts += 1

    def _initialize(self) -> None: ...


class Stream:
    def __init__(
        self, audio: PortAudio, rate: int, size: int, *, device: Any, callback: Any, channels: int, dtype: str
    ):
        assert (channels, dtype) == (1, "int16")
        self.audio = audio
        self.rate, self.size, self.device, self.callback = rate, size, device, callback
        self.open = True

    def start(self) -> None:
        if self.audio.broken == "loudspeaker that opens" and self is self.audio.loudspeaker:
            raise self.audio.PortAudioError("Error starting stream")

    def abort(self) -> None: ...

    def close(self) -> None:
        self.open = False

    def take(self, data: bytes) -> None:
        self.callback(data, self.size, None, None)

    def give(self) -> bytes:
        data = bytearray(2 * self.size)
        self.callback(data, self.size, None, None)
        return bytes(data)


@pytest.fixture
def audio(monkeypatch: pytest.MonkeyPatch) -> PortAudio:
    one = PortAudio()
    monkeypatch.setattr(device_line, "portaudio", lambda: one)
    return one


def test_sound_passes_from_the_microphone_and_to_the_loudspeaker(audio: PortAudio) -> None:
    async def follow() -> None:
        line = DeviceLine("default", "Headset")
        assert (audio.microphone.rate, audio.loudspeaker.rate) == (16000, 24000)
        assert (audio.microphone.device, audio.loudspeaker.device) == (None, "Headset")
        blocks = line.blocks()
        audio.microphone.take(b"\1\2" * 320)
        assert await anext(blocks) == b"\1\2" * 320
        line.play(b"\3\4" * 700)
        assert audio.loudspeaker.give() == b"\3\4" * 480
        assert line.played == 480 / 24000
        assert audio.loudspeaker.give() == (b"\3\4" * 220).ljust(960, b"\0")
        await line.drained()
        assert line.played == 700 / 24000
        line.play(b"\5\6" * 2000)
        line.stop()
        await line.drained()
        assert audio.loudspeaker.give() == bytes(960) and line.played == 700 / 24000
        line.close()
        assert [block async for block in blocks] == []
        assert not audio.microphone.open and not audio.loudspeaker.open

    run(follow)


def test_an_unplugged_microphone_is_reopened_when_it_is_back(audio: PortAudio) -> None:
    async def follow() -> None:
        line = DeviceLine()
        first = audio.microphone
        blocks = line.blocks()
        first.take(bytes(640))
        await anext(blocks)
        audio.broken = "microphone"  # from now on, no blocks arrive

        def plug_in() -> None:
            audio.broken = ""

        asyncio.get_running_loop().call_later(7.0, plug_in)
        waiting = asyncio.ensure_future(anext(blocks))
        while audio.microphone is first:
            await asyncio.wait([waiting], timeout=1.0)
        audio.microphone.take(b"\1\1" * 320)
        assert await waiting == b"\1\1" * 320
        assert line.lost == 1 and audio.restarts > 1 and not first.open
        assert asyncio.get_running_loop().time() > 7.0
        line.close()

    run(follow)


def test_the_agent_continues_without_its_loudspeaker_and_finds_it_again(
    audio: PortAudio, caplog: pytest.LogCaptureFixture
) -> None:
    """The agent keeps listening. It looks for the loudspeaker only when it has something to say."""

    async def follow() -> None:
        line = DeviceLine("default", "Headset")
        first = audio.loudspeaker
        feeding = asyncio.create_task(feed_microphone(audio))
        first.give()
        line.play(bytes(9600))
        first.give()
        audio.broken = "loudspeaker"  # from now on, the loudspeaker takes no sound
        await line.drained()
        assert line.lost == 1 and not first.open and line.played == 960 / 48000
        blocks = line.blocks()
        for _ in range(WAITING + 10):
            assert await anext(blocks) == bytes(640)
        assert audio.microphone.open and line.lost == 1
        line.play(bytes(9600))
        await line.drained()
        assert line.lost == 2 and audio.loudspeaker is first
        audio.broken = ""
        line.play(bytes(960))
        line.play(bytes(960))
        while audio.loudspeaker is first:
            await anext(blocks)
        audio.loudspeaker.give()
        audio.loudspeaker.give()
        await line.drained()
        assert audio.loudspeaker.device == "Headset" and line.lost == 3 and line.played == 3 * 960 / 48000
        line.close()
        feeding.cancel()

    run(follow)
    assert "the loudspeaker is gone: looking for it again" in caplog.messages
    assert caplog.messages[-1] == "the loudspeaker is back"


def test_a_loudspeaker_that_opens_but_does_not_start_is_not_back(
    audio: PortAudio, caplog: pytest.LogCaptureFixture
) -> None:
    async def follow() -> None:
        line = DeviceLine()
        first = audio.loudspeaker
        feeding = asyncio.create_task(feed_microphone(audio))
        line.play(bytes(9600))
        audio.broken = "loudspeaker that opens"
        await line.drained()
        assert audio.loudspeaker is not first and not audio.loudspeaker.open and audio.microphone.open
        await anext(line.blocks())
        line.close()
        feeding.cancel()

    run(follow)
    assert caplog.messages[-1] == "the loudspeaker is still away: the agent goes on without it"


async def feed_microphone(audio: PortAudio) -> None:
    """Deliver a block every 20 ms."""
    loop = asyncio.get_running_loop()
    while True:
        audio.microphone.take(bytes(640))
        tick = loop.create_future()
        loop.call_later(0.02, tick.set_result, None)
        await tick


def test_a_long_speech_ends_even_if_the_loudspeaker_is_lost(audio: PortAudio) -> None:
    async def follow() -> None:
        line = DeviceLine("", "default")
        assert audio.microphone is None
        mouth = Mouth(line, None)  # type: ignore[arg-type]  # this test needs no synthesiser
        audio.broken = "loudspeaker"
        mouth.begin()
        mouth.queue(Spoken("a long sentence", bytes(48000 * 10), b"", ()), 0)
        await mouth.room()
        mouth.queue(Spoken("and another one", bytes(48000 * 10), b"", ()), 15)
        await mouth.room()
        await mouth.played_out()
        assert mouth.lead == 0.0
        line.close()

    run(follow)


@pytest.mark.parametrize(("broken", "setting"), [("microphone", "source"), ("loudspeaker", "sink")])
def test_the_error_names_a_device_that_cannot_be_opened_and_its_setting(
    audio: PortAudio, broken: str, setting: str
) -> None:
    audio.broken = broken

    async def follow() -> None:
        with pytest.raises(PlatformError, match=rf"cannot open the {broken} .*voiceio\.{setting}=NAME"):
            DeviceLine()

    run(follow)
    assert broken == "microphone" or not audio.microphone.open


def test_an_agent_that_reads_too_slowly_loses_the_oldest_sound(audio: PortAudio) -> None:
    async def follow() -> None:
        line = DeviceLine()
        for number in range(device_line.WAITING + 5):
            audio.microphone.take(bytes([number % 250, 0]))
        await asyncio.sleep(0)  # let the loop run the callbacks that deliver the blocks; the clock does not advance
        assert (await anext(line.blocks()))[0] == 5
        line.close()

    run(follow)


def test_the_real_portaudio_can_be_loaded() -> None:
    """On a machine without audio devices, the error message refers to ``ravestate voice check``."""
    audio = device_line.portaudio()
    if len(audio.query_devices()) == 0:

        async def follow() -> None:
            with pytest.raises(PlatformError, match="ravestate voice check"):
                DeviceLine()

        run(follow)
    device_line.restart()
