"""The log of a chat goes to a file, so that it does not appear between the lines of the chat."""

import logging
import os
import select
import subprocess
import sys
from pathlib import Path

import pytest

from ravestate.modules.platform.conio.log_file import log_file, log_to_file

LIMIT = 20

AGENT = """
import logging
import ravestate as rs
from ravestate.modules import conio, rawio

logging.basicConfig()
parrot = rs.Module("parrot", requires=[rawio])

@parrot.rule(when=rawio.input.changed, writes=rawio.output)
async def repeat(ctx):
    ctx.log.warning("careful: %s", ctx.payload(rawio.input.changed))
    ctx[rawio.output] = ctx.payload(rawio.input.changed).upper()

rs.run(parrot, conio)
"""

SLOW_AGENT = """
import logging
import threading
import time
import ravestate as rs
from ravestate.modules import conio, rawio
from ravestate.runtime import plain_rules, workers

workers.SHARE = 1
plain_rules.STARVED = 0.01
logging.basicConfig()
parrot = rs.Module("parrot", requires=[rawio])
warned = threading.Event()

class Watch(logging.Handler):
    def emit(self, record):
        if "wait for a worker thread" in record.getMessage():
            warned.set()

logging.getLogger("ravestate").addHandler(Watch())

@parrot.rule(when=rawio.input.changed, writes=rawio.output)
async def repeat(ctx):
    begun = time.thread_time()
    while time.thread_time() < begun + 0.15:
        pass
    ctx[rawio.output] = ctx.payload(rawio.input.changed).upper()

@parrot.rule(when=rawio.input.changed)
def hang(ctx):
    warned.wait(20)

@parrot.rule(when=rawio.input.changed)
def wait_for_a_thread(ctx):
    pass

rs.run(parrot, conio)
"""

terminals = pytest.mark.skipif(os.name != "posix", reason="needs pseudo-terminals")


def talk(folder: Path, *, redirected: bool, agent: str = AGENT) -> tuple[bytes, str]:
    """Type two lines on a terminal. Return the text on the terminal, and the text on the redirected standard error."""
    ours, theirs = os.openpty()
    run = subprocess.Popen(
        [sys.executable, "-c", agent],
        stdin=theirs,
        stdout=theirs,
        stderr=subprocess.PIPE if redirected else theirs,
        env={**os.environ, "TERM": "xterm", "XDG_STATE_HOME": str(folder), "HOME": str(folder)},
        start_new_session=True,
    )
    os.close(theirs)
    seen = b""
    errors = b""
    typed = b""
    again = 6  # the number of times that keys are typed again, in all: a suspended prompt can lose them

    def read() -> bool:
        """Act as the terminal; return whether the program's side is still open."""
        nonlocal seen, again
        while not select.select([ours], [], [], 5.0)[0]:
            again -= 1
            assert again and run.poll() is None, seen
            os.write(ours, typed)
        try:
            received = os.read(ours, 4096)
        except OSError:  # Linux: the other side of the pseudo-terminal is closed
            return False
        seen += received
        os.write(ours, b"\x1b[1;1R" * received.count(b"\x1b[6n"))
        return bool(received)

    with run:
        for text, keys in ((b"\x1b[?2004h", b"hello\r"), (b"HELLO", b"again\r"), (b"AGAIN", b"\x04")):
            while text not in seen:
                assert read(), seen
            typed = keys
            os.write(ours, keys)
        while read():
            pass
        if run.stderr is not None:
            errors = run.stderr.read()
        assert run.wait(LIMIT) == 0
    os.close(ours)
    return seen, errors.decode()


@terminals
def test_log_lines_go_to_a_file_and_not_to_the_terminal(tmp_path: Path) -> None:
    seen, _ = talk(tmp_path, redirected=False)
    (file,) = tmp_path.rglob("log")
    lines = file.read_text().splitlines()
    assert [line.partition(" WARNING ")[2] for line in lines] == [
        "ravestate.parrot.repeat: careful: hello",
        "ravestate.parrot.repeat: careful: again",
    ]
    assert file.stat().st_mode & 0o777 == 0o600
    assert b"careful" not in seen
    assert seen.decode().rstrip().endswith(f"The log of this chat has 2 warnings: {file}")


@terminals
def test_warnings_about_slow_rules_go_to_the_log_and_not_to_the_terminal(tmp_path: Path) -> None:
    seen, _ = talk(tmp_path, redirected=False, agent=SLOW_AGENT)
    (file,) = tmp_path.rglob("log")
    text = file.read_text()
    assert "rule parrot:repeat (<string>:22) blocked the loop" in text
    assert "plain functions wait for a worker thread: parrot:wait_for_a_thread" in text
    assert b"blocked" not in seen
    assert b"worker" not in seen


@terminals
def test_a_redirected_log_does_not_go_to_a_file(tmp_path: Path) -> None:
    seen, errors = talk(tmp_path, redirected=True)
    assert b"careful" not in seen
    assert errors.splitlines() == [
        "WARNING:ravestate.parrot.repeat:careful: hello",
        "WARNING:ravestate.parrot.repeat:careful: again",
    ]
    assert not list(tmp_path.rglob("log"))


class Terminal:
    """A stand-in for a terminal, which keeps the text."""

    def __init__(self) -> None:
        self.text = ""

    def isatty(self) -> bool:
        return True

    def write(self, text: str) -> int:
        self.text += text
        return len(text)

    def flush(self) -> None: ...


def on_terminal(monkeypatch: pytest.MonkeyPatch) -> Terminal:
    """Put both standard streams on a terminal. In a fixture, pytest would undo this before the test."""
    terminal = Terminal()
    monkeypatch.setattr(sys, "stdout", terminal)
    monkeypatch.setattr(sys, "stderr", terminal)
    return terminal


def test_after_the_chat_the_log_goes_to_its_old_place_again(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    terminal = on_terminal(monkeypatch)
    log, handler = logging.getLogger(), logging.StreamHandler(terminal)
    log.addHandler(handler)
    try:
        before = list(log.handlers)
        with log_to_file(tmp_path / "state" / "log"):
            log.warning("inside")
        assert set(log.handlers) == set(before)
        log.warning("outside")
    finally:
        log.removeHandler(handler)
    assert terminal.text == f"The log of this chat has 1 warning: {tmp_path / 'state' / 'log'}\noutside\n"


def test_a_chat_without_warnings_does_not_mention_its_log(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    terminal = on_terminal(monkeypatch)
    with log_to_file(tmp_path / "log"):
        pass
    assert terminal.text == ""


def test_a_file_that_cannot_be_written_leaves_the_log_as_it_is(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    on_terminal(monkeypatch)
    before = list(logging.getLogger().handlers)
    with log_to_file(tmp_path):  # this is a folder, so it cannot be written
        assert logging.getLogger().handlers == before


def test_a_full_disk_neither_ends_the_chat_nor_appears_in_it(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    terminal = on_terminal(monkeypatch)
    file = tmp_path / "log"
    file.symlink_to("/dev/full")
    with log_to_file(file):
        logging.getLogger().warning("inside")
        assert terminal.text == ""
    assert terminal.text == f"The log of this chat has 1 warning: {file}\n"


def test_the_log_file_is_in_the_state_folder(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr(sys, "platform", "linux")
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path))
    assert log_file() == tmp_path / "ravestate" / "log"
