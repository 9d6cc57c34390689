"""The console on a scripted screen, on pipes and on a terminal."""

import asyncio
import errno
import io
import os
import subprocess
import sys
from pathlib import Path

import pytest

from ravestate.errors import PlatformError
from ravestate.modules.platform.conio.console import Console, history_file, prepare

ECHO = """
import asyncio, sys
from pathlib import Path
from ravestate.modules.platform.conio.console import Console

async def main():
    async with Console(history=Path(sys.argv[1])) as console:
        async for line in console:
            console.utter(f"heard {line!r}")
            for piece in ("What", " do", " you mean?"):
                console.grow(piece)
            if line == "bye":
                break
    print("ending:", console.ending, file=sys.stderr)

asyncio.run(main())
"""


class Script:
    """A screen that returns the lines and raises the exceptions of a script. It keeps its output in `log`."""

    interactive = True

    def __init__(self, *script: str | BaseException) -> None:
        self.script = list(script)
        self.log: list[str] = []
        self.broken: Exception | None = None

    async def __aenter__(self) -> object:
        self.log.append("begin")
        return self

    async def __aexit__(self, *_: object) -> None:
        self.log.append("finish")

    async def read(self) -> str:
        step = self.script.pop(0) if self.script else EOFError()
        if isinstance(step, BaseException):
            raise step
        return step

    def _log(self, what: str) -> None:
        if self.broken:
            raise self.broken
        self.log.append(what)

    def show(self, text: str) -> None:
        self._log(f"show {text}")

    def stream(self, piece: str) -> None:
        self._log(f"stream {piece}")

    def end(self) -> None:
        self._log("end")


def heard(screen: Script) -> tuple[list[str], Console]:
    async def main() -> tuple[list[str], Console]:
        async with Console(screen) as console:
            return [line async for line in console], console

    return asyncio.run(main())


@pytest.mark.parametrize(
    ("last", "ending"),
    [
        (EOFError(), "end of input"),
        (KeyboardInterrupt(), "interrupt"),
        (OSError(5, "Input/output error"), "closed"),
    ],
)
def test_the_console_yields_lines_until_the_input_ends(last: BaseException, ending: str) -> None:
    screen = Script("hello", "", "a\x1b[2Jb\x00\udcff", last, "never")
    lines, console = heard(screen)
    assert lines == ["hello", "", "ab\ufffd"]
    assert console.ending == ending
    assert screen.log == ["begin", "finish"]
    with pytest.raises(StopAsyncIteration):
        asyncio.run(console.__anext__())


def test_output_is_clean_and_in_order() -> None:
    screen = Script()
    console = Console(screen)
    console.utter("one\x07\r\ntwo\x1b]0;x\x07")
    console.grow("th")
    console.grow("\x1b")
    console.grow("ree")
    console.utter("four")
    console.fall_silent()
    assert screen.log == ["show one\ntwo", "stream th", "stream ree", "end", "show four"]


def test_after_streamed_pieces_only_the_rest_of_the_utterance_is_shown() -> None:
    screen = Script()
    console = Console(screen)
    for whole in ("Hello you!", "Hello", "Help!", "again"):
        console.grow("Hel")
        console.grow("lo")
        console.utter(whole)
        console.fall_silent()
    streamed = ["stream Hel", "stream lo"]
    assert screen.log == [
        *streamed, "stream  you!", "end",
        *streamed, "end",
        *streamed, "end", "show Help!",
        *streamed, "end", "show again",
    ]  # fmt: skip


def test_another_utterance_during_a_stream_gets_its_own_line() -> None:
    screen = Script()
    console = Console(screen)
    console.grow("Hello")
    console.utter("Look!")
    console.grow(" to")
    console.utter("Hello to you!")
    assert screen.log == ["stream Hello", "end", "show Look!", "stream  to", "stream  you!", "end"]


def test_a_streamed_line_ends_when_the_console_closes() -> None:
    screen = Script()

    async def main() -> None:
        async with Console(screen) as console:
            console.grow("half")

    asyncio.run(main())
    assert screen.log == ["begin", "stream half", "end", "finish"]


@pytest.mark.parametrize("broken", [BrokenPipeError(), ValueError("I/O operation on closed file")])
def test_writing_to_a_closed_output_ends_the_console(broken: Exception) -> None:
    screen = Script("hello")
    console = Console(screen)
    screen.broken = broken
    console.utter("one")
    console.grow("two")
    console.fall_silent()
    assert console.ending == "closed"
    with pytest.raises(StopAsyncIteration):
        asyncio.run(console.__anext__())


def test_without_a_terminal_the_console_reads_and_writes_plain_lines(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    printed = io.StringIO()
    (tmp_path / "typed").write_text("one\ntwo\n")
    with (tmp_path / "typed").open() as typed:
        plain = Console(stdin=typed, stdout=printed)
        assert not plain.interactive
        assert asyncio.run(_lines(plain)) == ["one", "two"]
    assert printed.getvalue() == "hello\n"
    assert Console(Script()).interactive
    monkeypatch.setattr(sys, "stdin", None)
    monkeypatch.setattr(sys, "stdout", None)
    lines = asyncio.run(_lines(Console()))
    assert lines == []


async def _lines(console: Console) -> list[str]:
    async with console:
        console.utter("hello")
        return [line async for line in console]


def test_the_message_without_prompt_toolkit_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    class Terminal(io.StringIO):
        def isatty(self) -> bool:
            return True

    monkeypatch.delitem(sys.modules, "ravestate.modules.platform.conio.terminal", raising=False)
    monkeypatch.setitem(sys.modules, "prompt_toolkit", None)
    with pytest.raises(PlatformError, match=r"needs prompt_toolkit: pip install 'ravestate\[console\]'"):
        Console(stdin=Terminal(), stdout=Terminal())


def test_the_history_file_is_in_the_state_folder(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "platform", "linux")
    monkeypatch.setenv("XDG_STATE_HOME", "/state")
    assert history_file() == Path("/state/ravestate/history")


# -------------------------------------------------------------------------- in a separate process


def test_a_program_reads_and_writes_through_pipes(tmp_path: Path) -> None:
    run = subprocess.run(
        [sys.executable, "-c", ECHO, str(tmp_path / "history")],
        input=b"hello\ncaf\xe9\x00\n" + b"x" * 100_000 + b"\nlast",
        capture_output=True,
        check=True,
    )
    question = "What do you mean?"
    said = ["heard 'hello'", "heard 'caf\ufffd'", f"heard '{'x' * 100_000}'", "heard 'last'"]
    assert run.stdout.decode().splitlines() == [line for first in said for line in (first, question)]
    assert run.stderr.decode() == "ending: end of input\n"
    assert not (tmp_path / "history").exists()


def test_the_console_reports_a_full_disk_as_a_failure_but_not_a_broken_pipe() -> None:
    async def ended_by(error: OSError) -> PlatformError | None:
        script = Script("hello")
        script.broken = error
        async with Console(script) as console:
            console.utter("hello")
            assert [line async for line in console] == []
            assert console.ending == "closed"
            return console.failure

    assert asyncio.run(ended_by(BrokenPipeError(errno.EPIPE, "Broken pipe"))) is None
    failure = asyncio.run(ended_by(OSError(errno.ENOSPC, "No space left on device")))
    assert str(failure) == "conio: the agent's words cannot be written: No space left on device"


@pytest.mark.skipif(os.name != "posix", reason="needs POSIX pipes")
def test_the_console_ends_cleanly_if_the_reader_of_its_output_goes_away(tmp_path: Path) -> None:
    run = subprocess.Popen(
        [sys.executable, "-c", ECHO, str(tmp_path / "history")],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
    )
    assert run.stdin is not None
    assert run.stdout is not None
    assert run.stderr is not None
    with run:
        run.stdin.write(b"hello\n")
        run.stdin.flush()
        assert run.stdout.readline() == b"heard 'hello'\n"
        run.stdout.close()
        run.stdin.write(b"anybody?\n")
        run.stdin.flush()
        assert run.stderr.read() == b"ending: closed\n"
        assert run.wait() == 0


@pytest.mark.parametrize("is_terminal", [True, False])
def test_prepare_imports_the_terminal_library_only_for_a_terminal(
    monkeypatch: pytest.MonkeyPatch, is_terminal: bool
) -> None:
    class Stream(io.StringIO):
        def isatty(self) -> bool:
            return is_terminal

    monkeypatch.setattr(sys, "stdin", Stream())
    monkeypatch.setattr(sys, "stdout", Stream())
    monkeypatch.delitem(sys.modules, "ravestate.modules.platform.conio.terminal", raising=False)
    prepare()
    assert ("ravestate.modules.platform.conio.terminal" in sys.modules) is is_terminal
    monkeypatch.setitem(sys.modules, "prompt_toolkit", None)
    monkeypatch.delitem(sys.modules, "ravestate.modules.platform.conio.terminal", raising=False)
    prepare()  # `prepare` ignores a missing package; the console raises the error


@pytest.mark.skipif(os.name != "posix", reason="needs pseudo-terminals")
@pytest.mark.parametrize(("keys", "ending"), [(b"\x04", "end of input"), (b"\x03", "interrupt"), (b"bye\r", "None")])
def test_a_program_talks_on_a_terminal(tmp_path: Path, keys: bytes, ending: str) -> None:
    ours, theirs = os.openpty()
    history = tmp_path / "state" / "history"
    run = subprocess.Popen(
        [sys.executable, "-c", ECHO, str(history)],
        stdin=theirs,
        stdout=theirs,
        stderr=subprocess.PIPE,
        env={**os.environ, "TERM": "xterm"},
        start_new_session=True,
    )
    os.close(theirs)
    seen = b""

    def wait_for(text: bytes) -> None:
        """Act as the terminal until the program has written `text`."""
        nonlocal seen
        while text not in seen:
            received = os.read(ours, 4096)
            seen += received
            os.write(ours, b"\x1b[1;1R" * received.count(b"\x1b[6n"))
        seen = seen.partition(text)[2]

    assert run.stderr is not None
    with run:
        wait_for(b"\x1b[?2004h")  # now the prompt accepts keys
        os.write(ours, b"helo\x1b[Dl\r")  # the left arrow moves the cursor back, and then a letter is inserted
        wait_for(b"'hello'")
        wait_for(b"mean?")
        os.write(ours, b"\x1b[A\r")  # the up arrow recalls the previous line
        wait_for(b"'hello'")
        os.write(ours, b"caf\xe9" + b"y" * 2000 + b"\r")
        wait_for(b"'caf")
        wait_for(b"mean?")
        os.write(ours, keys)
        if keys.startswith(b"bye"):
            wait_for(b"'bye'")
        # On Unix, reading from a pseudo-terminal raises an error when the other side is closed.
        try:
            while received := os.read(ours, 4096):
                os.write(ours, b"\x1b[1;1R" * received.count(b"\x1b[6n"))
        except OSError:
            pass
        assert run.stderr.read().decode().endswith(f"ending: {ending}\n")
        assert run.wait() == 0
    os.close(ours)
    assert history.stat().st_mode & 0o777 == 0o600
    kept = [line for line in history.read_text().splitlines() if line.startswith("+")]
    assert kept[0] == "+hello"
