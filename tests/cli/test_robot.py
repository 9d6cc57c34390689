"""``ravestate robot`` serves a stand-in for a robot, together with an agent and its chat page."""

import contextlib
import os
import signal
import subprocess
import sys
import urllib.request
import webbrowser
from collections.abc import Callable, Generator
from pathlib import Path

import pytest

from ravestate.cli import main
from ravestate.runtime import run as runtime_run

PARROT = """
import ravestate as rs
from ravestate.modules import rawio

module = rs.Module("parrot", requires=[rawio])

@module.rule(when=rawio.input.changed, writes=rawio.output)
async def answer(ctx):
    ctx[rawio.output] = ctx.payload(rawio.input.changed)
"""


def test_the_robots_page_and_the_chat_page_are_served_and_end_cleanly(tmp_path: Path) -> None:
    (tmp_path / "parrot.py").write_text(PARROT)
    line = [sys.executable, "-m", "ravestate", "robot", str(tmp_path / "parrot.py"), "webio", "--on", "bus"]
    line += ["--bus", "127.0.0.1:0", "--port", "0", "--set", "webio.port=0"]
    process = subprocess.Popen(line, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env={**os.environ})
    assert process.stdout is not None
    said = process.stdout.readline()
    assert said.startswith("Roboy is at http://127.0.0.1:") and "its topics are on the built-in bus" in said
    assert process.stdout.readline().startswith("The agent is at http://127.0.0.1:")
    with urllib.request.urlopen(said.split()[3].rstrip(",")) as page:
        assert "assets/robot.js" in page.read().decode()
    process.send_signal(signal.SIGINT)
    _, errors = process.communicate(timeout=20)
    assert (process.returncode, errors) == (0, "")


@pytest.mark.parametrize(
    ("screen", "more", "opens"),
    [(True, [], True), (False, [], False), (False, ["--browser"], True), (True, ["--no-browser"], False)],
)
def test_the_robots_page_opens_by_itself_if_the_session_has_a_screen(
    screen: bool, more: list[str], opens: bool, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    @contextlib.contextmanager
    def asked_at_once(stop: Callable[[], None]) -> Generator[None]:
        stop()
        yield

    opened: list[str] = []
    monkeypatch.setattr(webbrowser, "open", opened.append)
    monkeypatch.setattr(runtime_run, "asked_by_signals", asked_at_once)
    monkeypatch.setattr(sys, "platform", "linux")
    monkeypatch.setattr(sys.stdout, "isatty", lambda: screen)
    monkeypatch.setenv("DISPLAY", ":0")
    assert main(["robot", "--on", "bus", "--bus", "127.0.0.1:0", "--port", "0", *more]) == 0
    address = capsys.readouterr().out.split()[3].rstrip(",")
    assert opened == ([address] if opens else [])


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        (["--bus", "nonsense"], "bus='nonsense' is not an address: write HOST:PORT"),
        (["--bus", "127.0.0.1:99999"], "bus='127.0.0.1:99999' is not an address"),
        (["--bus", "127.0.0.1:0", "--port", "99999"], "cannot listen on port 99999"),
        (["--on", "auto", "--set", "ros1.master=http://localhost:99999", "--bus", "x"], "bus='x' is not an address"),
    ],
)
def test_a_wrong_address_is_refused_with_a_message(
    wrong: list[str], words: str, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv("ROS_VERSION", raising=False)
    assert main(["robot", "--on", "bus", *wrong]) == 1
    assert words in capsys.readouterr().err


def test_an_unknown_robot_is_refused_with_a_message(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["robot", "--robot", "robby", "--on", "bus", "--bus", "127.0.0.1:0"]) == 1
    assert "did you mean 'roboy'" in capsys.readouterr().err
