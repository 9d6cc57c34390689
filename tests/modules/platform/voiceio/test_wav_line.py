"""A line between two files: blocks come at their times, and the output has the timeline of the recording."""

import asyncio
import wave
from collections.abc import Awaitable, Callable
from pathlib import Path

import pytest

from modules.platform.voiceio.speech import noise, wav
from ravestate.errors import PlatformError
from ravestate.modules.platform.voiceio.playout import SECOND
from ravestate.modules.platform.voiceio.wav_line import WavLine
from ravestate.testing.virtual_loop import VirtualLoop


def run(test: Callable[[], Awaitable[None]]) -> None:
    loop = VirtualLoop()
    try:
        loop.run_until_complete(test())  # type: ignore[arg-type]
        loop.run_until_complete(loop.shutdown_asyncgens())
    finally:
        loop.close()


def test_blocks_come_at_their_times_and_silence_follows(tmp_path: Path) -> None:
    file = wav(tmp_path / "in.wav", noise(0.1, 5000))

    async def follow() -> None:
        line = WavLine(file)
        loop, begun, seen = asyncio.get_running_loop(), asyncio.get_running_loop().time(), 0
        async for block in line.blocks():
            seen += 1
            assert len(block) == 640
            assert loop.time() - begun == pytest.approx(seen * 0.02)
            assert any(block) == (seen <= 5) and line.ended == (seen >= 5)
            if seen == 8:
                line.close()
        assert seen == 8

    run(follow)


def test_the_output_file_has_the_same_timeline_as_the_recording(tmp_path: Path) -> None:
    file = wav(tmp_path / "in.wav", bytes(3 * 32000))

    async def follow() -> None:
        line = WavLine(file, tmp_path / "out.wav")
        async for _ in line.blocks():
            now = asyncio.get_running_loop().time()
            if now == pytest.approx(0.5):
                line.play(b"\1\1" * (SECOND // 2))
            if now == pytest.approx(1.0):
                assert line.played == pytest.approx(0.5)
                line.stop()
            if now == pytest.approx(1.5):
                await line.drained()  # returns immediately, because nothing is queued
                line.play(b"\2\2" * (SECOND // 4))
                await line.drained()
                assert asyncio.get_running_loop().time() == pytest.approx(2.0)
                assert line.played == pytest.approx(1.0)
            if line.ended:
                break
        line.close()

    run(follow)
    with wave.open(str(tmp_path / "out.wav")) as out:
        assert (out.getframerate(), out.getnchannels(), out.getnframes() / 24000) == (
            24000,
            1,
            pytest.approx(3.0, abs=0.03),
        )
        sound = out.readframes(out.getnframes())
    sounding = [sound[2 * round(time * 24000)] for time in (0.45, 0.55, 0.95, 1.05, 1.45, 1.55, 1.95, 2.05)]
    assert sounding == [0, 1, 1, 0, 0, 2, 2, 0]


def test_a_missing_recording_is_refused(tmp_path: Path) -> None:
    async def follow() -> None:
        with pytest.raises(PlatformError, match=r"none\.wav"):
            WavLine(tmp_path / "none.wav")

    run(follow)


@pytest.mark.parametrize("name", ["folder.wav", "none/out.wav", "out.mp3", "out"])
def test_an_output_file_that_cannot_be_written_is_refused_immediately(name: str, tmp_path: Path) -> None:
    (tmp_path / "folder.wav").mkdir()
    with pytest.raises(PlatformError, match="cannot write"):
        WavLine(None, tmp_path / name)
