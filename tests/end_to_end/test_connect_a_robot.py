"""The how-to "Connect a robot": run all its commands, beginning in an empty folder."""

import contextlib
import json
import os
import re
import shlex
import signal
import subprocess
import sys
import threading
import tomllib
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from websockets.sync.client import connect

from modules.platform.ros.networks import Ros1, end
from ravestate.cli import main
from repo.snippets import blocks_in, save

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs" / "how-to" / "connect-a-robot.md"
EXTRAS = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["optional-dependencies"]
STAYS = ("ravestate robot", "ravestate run")
"""The beginnings of commands that run until Ctrl-C."""


class Reader:
    """Runs the commands of a page as a reader would, and checks their output."""

    def __init__(self, folder: Path, capture: pytest.CaptureFixture[str], start_master: Callable[[], None]) -> None:
        self.folder = folder
        self._capture = capture
        self._start_master = start_master
        self._running: list[subprocess.Popen[str]] = []

    def type(self, command: str, shown: list[str]) -> str:
        """Run a command, check that its output has these lines, and return the output."""
        if command.startswith("ravestate robot"):
            command += " --port 0"
        if command.startswith(STAYS):
            return self._start(command, shown)
        if extras := re.fullmatch(r"pip install 'ravestate\[(.*)\]'", command):
            assert set(extras[1].split(",")) <= set(EXTRAS)
            return ""
        if folder := re.fullmatch(r"mkdir (\w+) && cd (\w+)", command):
            assert folder[1] == folder[2]
            self.folder /= folder[1]
            self.folder.mkdir()
            return ""
        program, *arguments = shlex.split(command)
        assert program == "ravestate", command
        if arguments == ["ros", "check"]:
            self._start_master()
        faults = any(line.startswith("FAULT") for line in shown)
        with contextlib.chdir(self.folder):
            code = main(arguments)
        said, complaint = self._capture.readouterr()
        assert code == int(faults), f"{command}\n{said}\n{complaint}"
        assert set(shown) <= set(said.splitlines()), f"{command}\n{said}"
        return said

    def _start(self, command: str, shown: list[str]) -> str:
        process = subprocess.Popen(
            [sys.executable, "-m", *shlex.split(command)], cwd=self.folder, text=True, stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
        )  # fmt: skip
        self._running.append(process)
        assert process.stdout is not None
        said = ""
        for line in shown:
            said += process.stdout.readline()
            assert re.sub(r":\d+/", ":8421/", said.splitlines()[-1]) == line
        return said

    def end(self) -> None:
        """End the running commands as Ctrl-C does, and check that they end cleanly."""
        while self._running:
            process = self._running.pop()
            process.send_signal(signal.SIGINT)
            _, errors = process.communicate(timeout=60)
            assert (process.returncode, errors) == (0, "")

    def kill(self) -> None:
        for process in self._running:
            process.kill()
            process.communicate()


@pytest.fixture
def reader(tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> Iterator[Reader]:
    network = Ros1()
    end(network.master)  # there is no master until `ros check`
    variables = {
        **network.environment, "PYTHONPATH": str(ROOT / "src"), "ROS_DOMAIN_ID": str(1 + (os.getpid() + 50) % 100),
        "RAVESTATE_ROBOYIO_BUS": "127.0.0.1:0",
    }  # fmt: skip
    for name, value in variables.items():
        monkeypatch.setenv(name, value)
    # Look often enough to find all nodes on a busy machine. The nodes that `patrol.py` names do not run in this test.
    monkeypatch.setattr("ravestate.modules.platform.ros.checking.LOOKS", 12)
    made = Reader(tmp_path, capsys, network.start_master)
    before = set(sys.modules)
    yield made
    made.kill()
    network.stop()
    for name in set(sys.modules) - before:
        if str(tmp_path) in str(getattr(sys.modules[name], "__file__", "")):
            del sys.modules[name]


@contextlib.contextmanager
def speaking(address: str) -> Iterator[threading.Event]:
    """Ask a question again and again from the robot's left. Yield an event, set when the robot has turned and answered."""
    answered, enough = threading.Event(), threading.Event()

    def speak() -> None:
        turned = said = False
        with connect(address.replace("http", "ws") + "ws") as page:
            while not enough.is_set():
                page.send(json.dumps({"say": "Where is the lab?", "direction": 0.5}))
                with contextlib.suppress(TimeoutError):
                    while True:
                        looks = json.loads(page.recv(timeout=0.5))
                        turned, said = turned or looks["yaw"] > 0.2, said or looks["text"] == "Follow me, please."
                        if turned and said:
                            answered.set()

    thread = threading.Thread(target=speak)
    thread.start()
    try:
        yield answered
    finally:
        enough.set()
        thread.join()


def test_each_command_of_the_page_works(reader: Reader) -> None:
    typed: list[str] = []
    with contextlib.ExitStack() as conversation:
        answered = threading.Event()
        for block in blocks_in(PAGE):
            if block.title is not None:
                save(block, reader.folder)
            if block.language != "console":
                continue
            commands = [part.splitlines() for part in re.split(r"^\$ ", block.code, flags=re.MULTILINE) if part]
            for command, *shown in commands:
                if command.startswith("ravestate robot"):
                    conversation.close()
                    reader.end()
                said = reader.type(command, shown)
                if command.startswith("ravestate robot"):
                    answered = conversation.enter_context(speaking(said.split()[3].rstrip(",")))
                if command.startswith(("ravestate robot guide.py", "ravestate run")):
                    assert answered.wait(60), f"{command}: the robot did not turn and answer"
                typed.append(command)
        conversation.close()
        reader.end()
    assert len(typed) >= 8
