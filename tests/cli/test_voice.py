"""``ravestate voice``: what is missing, transcripts, speech, and conversations with a recording."""

import re
import wave
from pathlib import Path

import pytest

from cli.examples import call
from modules.platform.voiceio.speech import PEOPLE, noise, track, wav

TINY = ("--set", "voiceio.model=tiny.en", "--set", "voiceio.voice=espeak")

STORYTELLER = """
import ravestate as rs
from ravestate.modules import rawio

module = rs.Module("echo", requires=[rawio])

@module.rule(when=rawio.input.changed, writes=rawio.output)
async def answer(ctx):
    ctx[rawio.output] = "You said something about the weather today."
"""


def test_check_lists_the_parts(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    code, out, errors = call(capsys, "voice", "check", *TINY)
    assert (code, errors) == (0, "")
    rows = {line.split("  ")[0].strip(): line for line in out.splitlines()}
    assert "ok" in rows
    for part in (
        "packages",
        "recogniser",
        "voice",
        "speech detector",
        "end of turn",
        "echo",
        "microphone",
        "loudspeaker",
    ):
        assert any(part in line for line in out.splitlines()), part
    assert "tiny.en" in out and "espeak:en" in out


def test_check_says_how_to_get_what_is_missing(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    code, out, _ = call(capsys, "voice", "check", "--set", "voiceio.model=huge", "--set", "voiceio.voice=espeak")
    assert code == 1
    assert re.search(r"MISSING +recogniser .*ravestate voice get huge", out)


def test_transcribe_prints_a_line_for_each_file(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    person = PEOPLE / "librivox" / "sense_and_sensibility_01_austen_64kb-0930.wav"
    hiss = wav(folder / "hiss.wav", noise(1.0, 500))
    code, out, errors = call(capsys, "voice", "transcribe", str(person), str(hiss), *TINY)
    assert (code, errors) == (0, "")
    first, second = out.split("\n")[:2]
    assert "might even have been made" in first and second == ""


def test_a_file_that_cannot_be_read_does_not_cost_the_others(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (folder / "bad.wav").write_bytes(b"no sound")
    good = wav(folder / "good.wav", track((0.3, "What time is it?"), length=2.0))
    code, out, errors = call(capsys, "voice", "transcribe", "bad.wav", "none.wav", str(good), *TINY)
    assert code == 1 and "time" in out and len(out.splitlines()) == 1
    assert "cannot read the sound of bad.wav" in errors and "no file none.wav" in errors
    code, _, errors = call(capsys, "voice", "transcribe", "bad.wav", *TINY)
    assert code == 1 and "Traceback" not in errors


def test_say_writes_a_file(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert call(capsys, "voice", "say", "Good morning to everyone.", "-o", "out.wav", *TINY) == (0, "", "")
    with wave.open("out.wav") as file:
        assert file.getframerate() == 24000 and 0.8 < file.getnframes() / 24000 < 4
    code, _, errors = call(capsys, "voice", "say", "Good morning.", "-o", "none/out.wav")
    assert code == 2 and "there is no folder none" in errors
    code, _, errors = call(capsys, "voice", "say", "Good morning.", "-o", "out.mp3")
    assert code == 2 and "ends in .wav" in errors


def test_talk_holds_a_conversation(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (folder / "echo.py").write_text(STORYTELLER)
    wav(folder / "in.wav", track((0.5, "What do you think about the weather?"), length=3.0))
    code, out, errors = call(capsys, "voice", "talk", "in.wav", "-o", "out.wav", "./echo.py", *TINY)
    assert (code, errors) == (0, "")
    user, agent = out.splitlines()
    times = [re.match(r" +(\d+\.\d\d) +(\d+\.\d\d)  (user|agent): +(.*)", line) for line in (user, agent)]
    assert all(times)
    assert times[0] and times[1]
    assert times[0][3] == "user" and "weather" in times[0][4] and float(times[0][1]) == pytest.approx(0.5, abs=0.2)
    assert times[1][3] == "agent" and times[1][4] == "You said something about the weather today."
    assert float(times[1][1]) > float(times[0][2])
    with wave.open("out.wav") as file:
        assert file.getnframes() / file.getframerate() >= float(times[1][2])


def test_wrong_use_is_told(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    code, _, errors = call(capsys, "voice", "talk", "none.wav", "-o", "out.wav", "rawio")
    assert code == 2 and "there is no file none.wav" in errors
    code, _, errors = call(capsys, "voice", "check", "--set", "voiceio.half=1")
    assert code == 2 and "half_duplex" in errors
