"""``ravestate voice``: missing parts, transcripts, speech, and conversations with a recording."""

import re
import signal
import subprocess
import sys
import wave
from pathlib import Path

import pytest

from cli.examples import call, complaints
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


def test_the_action_check_lists_the_parts(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
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


def test_the_action_check_says_how_to_get_what_is_missing(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    code, out, _ = call(capsys, "voice", "check", "--set", "voiceio.model=huge", "--set", "voiceio.voice=espeak")
    assert code == 1
    assert re.search(r"MISSING +recogniser .*ravestate voice get huge", out)


def test_the_action_transcribe_prints_a_line_for_each_file(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    person = PEOPLE / "librivox" / "sense_and_sensibility_01_austen_64kb-0930.wav"
    hiss = wav(folder / "hiss.wav", noise(1.0, 500))
    code, out, errors = call(capsys, "voice", "transcribe", str(person), str(hiss), *TINY)
    assert (code, errors) == (0, "")
    first, second = out.split("\n")[:2]
    assert "might even have been made" in first and second == ""


def test_a_file_that_cannot_be_read_does_not_stop_the_others(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (folder / "bad.wav").write_bytes(b"no sound")
    good = wav(folder / "good.wav", track((0.3, "What time is it?"), length=2.0))
    code, out, errors = call(capsys, "voice", "transcribe", "bad.wav", "none.wav", str(good), *TINY)
    assert code == 1 and "time" in out and len(out.splitlines()) == 1
    assert "cannot read the sound of bad.wav" in errors and "no file none.wav" in errors
    code, _, errors = call(capsys, "voice", "transcribe", "bad.wav", *TINY)
    assert code == 1 and "Traceback" not in errors


def test_the_action_say_writes_speech_to_a_file(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert call(capsys, "voice", "say", "Good morning to everyone.", "-o", "out.wav", *TINY) == (0, "", "")
    with wave.open("out.wav") as file:
        assert file.getframerate() == 24000 and 0.8 < file.getnframes() / 24000 < 4
    code, _, errors = call(capsys, "voice", "say", "Good morning.", "-o", "none/out.wav")
    assert code == 2 and "there is no folder none" in errors
    code, _, errors = call(capsys, "voice", "say", "Good morning.", "-o", "out.mp3")
    assert code == 2 and "ends in .wav" in errors


def test_the_action_talk_holds_a_conversation(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
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


def test_wrong_use_is_reported(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    code, _, errors = call(capsys, "voice", "talk", "none.wav", "-o", "out.wav", "rawio")
    assert code == 2 and "there is no file none.wav" in errors
    code, _, errors = call(capsys, "voice", "check", "--set", "voiceio.pause=abc")
    assert code == 2 and "voiceio.pause" in errors
    code, _, errors = call(capsys, "voice", "check", "--set", "voiceio.half=1")
    assert code == 2 and "half_duplex" in errors


def test_a_recording_is_never_overwritten(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = wav(folder / "q.wav", track((0.3, "What time is it?")))
    before = file.read_bytes()
    code, _, errors = call(capsys, "voice", "talk", "q.wav", "-o", "./q.wav", "rawio")
    assert code == 2 and "would be overwritten" in errors and file.read_bytes() == before


def test_a_name_that_does_not_end_in_wav_is_refused_with_advice(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    wav(folder / "rec.sound", noise(0.1, 500))
    code, _, errors = call(capsys, "voice", "talk", "rec.sound", "-o", "out.wav", "rawio")
    assert code == 2 and "rec.sound: name a recording that ends in .wav" in errors
    code, _, errors = call(capsys, "voice", "say", "Good morning.", "-o", "x.mp3")
    assert code == 2 and "ends in .wav" in errors and not (folder / "x.mp3").exists()
    code, _, errors = call(capsys, "voice", "transcribe", str(folder))
    assert code == 1 and "is a folder" in errors


def test_the_action_talk_leaves_out_other_platforms(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """The console would end the agent immediately, because its input is not a terminal."""
    (folder / "echo.py").write_text(STORYTELLER)
    (folder / "agent.yaml").write_text("modules: [conio, ./echo.py]\nsettings: {conio: {plain: true}}\n")
    wav(folder / "in.wav", track((0.5, "What do you think about the weather?"), length=3.0))
    code, out, errors = call(capsys, "voice", "talk", "in.wav", "-o", "out.wav", "agent.yaml", *TINY)
    assert code == 0 and "runs without conio" in errors
    assert out.splitlines()[-1].endswith("You said something about the weather today.")


def test_ctrl_c_ends_a_conversation_cleanly(folder: Path) -> None:
    """The rule `keep` reads the standard input in a thread, so virtual time stands still until Ctrl-C cancels the rule.

    The test keeps the input open until then, because the end of the input would end the conversation without Ctrl-C.
    """
    (folder / "slow.py").write_text(
        STORYTELLER
        + """
@module.rule(when=rs.startup.detached(), background=True)
async def wait(ctx):
    await ctx.sleep(100000)

@module.rule(when=rs.startup.detached())
async def keep(ctx):
    import asyncio, sys
    print("begun", flush=True)
    try:
        await asyncio.to_thread(sys.stdin.readline)
    except asyncio.CancelledError:
        print("cancelled", flush=True)
        raise
"""
    )
    wav(folder / "in.wav", track((0.5, "What do you think about the weather?"), length=3.0))
    command = [str(Path(sys.executable).parent / "ravestate"), "voice", "talk", "in.wav", "-o", "out.wav", "./slow.py"]
    pipe = subprocess.PIPE
    with subprocess.Popen([*command, *TINY], stdin=pipe, stdout=pipe, stderr=pipe, text=True) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == "begun\n"
        process.send_signal(signal.SIGINT)
        assert process.stdout.readline() == "cancelled\n"
        _, errors = process.communicate(timeout=60)
    assert (process.returncode, complaints(errors)) == (130, "")
