"""``ravestate run`` runs until the agent ends by itself, or until Ctrl-C."""

import signal
import subprocess
import sys
from pathlib import Path

import pytest

from cli.examples import HELLO, call, complaints, write


def test_an_agent_runs_to_its_end(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    write(folder / "hello.py", HELLO)
    code, out, _ = call(capsys, "run", "./hello.py")
    assert code == 0 and out.startswith("Hello")


def test_faults_give_exit_code_1_and_are_all_printed(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    write(
        folder / "faulty.py",
        """
        import ravestate as rs
        module = rs.Module("faulty")
        go = module.signal("go")

        @module.rule(when=go.min_age(9), weight=0)
        async def r(ctx): ...
        """,
    )
    code, out, errors = call(capsys, "run", "./faulty.py")
    assert (code, out) == (1, "")
    assert errors.startswith("ravestate run: 2 faults in the declarations:\n  - rule faulty:r (")
    assert "weight=0.0 must be above 0" in errors and "can never be at least 9 s" in errors


def test_ctrl_c_ends_the_agent_cleanly(folder: Path) -> None:
    write(
        folder / "waits.py",
        """
        import asyncio
        import ravestate as rs
        module = rs.Module("waits")

        @module.rule(when=rs.startup)
        async def wait(ctx):
            print("waiting", flush=True)
            await asyncio.get_running_loop().create_future()

        @module.rule(when=rs.shutdown)
        async def end(ctx):
            print("farewell", flush=True)
        """,
    )
    command = [str(Path(sys.executable).parent / "ravestate"), "run", "./waits.py"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == "waiting\n"
        process.send_signal(signal.SIGINT)
        out, errors = process.communicate(timeout=60)
    assert (process.returncode, out, complaints(errors)) == (0, "farewell\n", "")


def test_a_setting_of_the_wrong_type_gives_exit_code_2(capsys: pytest.CaptureFixture[str]) -> None:
    code, _, errors = call(capsys, "run", "idle", "--set", "idle.bored_after=abc")
    assert code == 2 and "setting idle.bored_after = 'abc': " in errors


def test_a_spoken_conversation_has_a_transcript_unless_another_platform_shows_the_text(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    ran: list[list[str]] = []
    monkeypatch.setattr("ravestate.runtime.run.run", lambda *modules, **_: ran.append([each.name for each in modules]))
    for modules in (["voiceio"], ["voiceio", "conio"], ["voiceio", "webio"], ["idle"]):
        assert call(capsys, "run", *modules) == (0, "", "")
    assert ["transcript" in modules for modules in ran] == [True, False, False, False]


def test_a_platform_without_a_user_is_reported(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """If another platform serves all users, the console and the voice have no user."""
    monkeypatch.setattr("ravestate.runtime.run.run", lambda *_, **__: None)
    code, _, errors = call(capsys, "run", "telegramio", "conio", "voiceio")
    assert code == 0 and "conio and voiceio will have no user: telegramio serves all users" in errors
    assert call(capsys, "run", "webio", "voiceio") == (0, "", "")  # the page has a microphone
