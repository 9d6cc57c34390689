"""The prompt on a terminal: the user types at the bottom, and output appears above."""

import asyncio
import io
import os
import sys
from collections.abc import Awaitable, Callable
from pathlib import Path
from typing import Any

import pytest
from prompt_toolkit.data_structures import Size
from prompt_toolkit.input import PipeInput, create_pipe_input
from prompt_toolkit.output import DummyOutput
from prompt_toolkit.output.vt100 import Vt100_Output

from ravestate.modules.platform.conio import terminal as terminal_file
from ravestate.modules.platform.conio.terminal import Terminal


class Paper(DummyOutput):
    """A terminal. It keeps the text that is printed above the prompt."""

    def __init__(self, columns: int = 20) -> None:
        self.columns = columns
        self.printed = ""
        self.broken: OSError | None = None
        self.flushed = asyncio.Event()

    def get_size(self) -> Size:
        return Size(rows=40, columns=self.columns)

    def flush(self) -> None:
        self.flushed.set()

    def write_raw(self, data: str) -> None:
        if self.broken:
            raise self.broken
        self.printed += data


class Screen(Vt100_Output):
    """A terminal that understands escape sequences."""

    def __init__(self, *arguments: Any, **options: Any) -> None:
        super().__init__(*arguments, **options)
        self.flushed = asyncio.Event()

    def flush(self) -> None:
        super().flush()
        self.flushed.set()


Play = Callable[[Terminal, PipeInput, Paper], Awaitable[None]]


def play(scene: Play, history: Path | None = None, columns: int = 20) -> str:
    async def main() -> str:
        paper = Paper(columns)
        with create_pipe_input() as keys:
            async with Terminal("> ", history, input=keys, output=paper) as terminal:
                await scene(terminal, keys, paper)
        return paper.printed.replace("\r\n", "\n")

    return asyncio.run(main())


async def drawn(paper: Paper | Screen) -> None:
    """Wait until the prompt is drawn again."""
    paper.flushed.clear()
    await paper.flushed.wait()


def message(terminal: Terminal) -> str:
    return "".join(fragment[1] for fragment in terminal.message())


def test_lines_can_be_typed_edited_recalled_and_pasted() -> None:
    async def scene(terminal: Terminal, keys: PipeInput, paper: Paper) -> None:
        keys.send_text("helo\x1b[Dl\r")
        assert await terminal.read() == "hello"
        keys.send_text("\x1b[A\r")
        assert await terminal.read() == "hello"
        pasted = f"\x1b[200~{'x' * 100_000}\x1b[201~\r"
        _, line = await asyncio.gather(asyncio.to_thread(keys.send_text, pasted), terminal.read())
        assert line == "x" * 100_000
        keys.send_text("\x04")
        with pytest.raises(EOFError):
            await terminal.read()
        keys.send_text("abc\x03")
        with pytest.raises(KeyboardInterrupt):
            await terminal.read()

    play(scene)


def test_a_colour_code_in_the_input_is_ignored(caplog: pytest.LogCaptureFixture) -> None:
    """prompt_toolkit takes such a code for a movement of the mouse, and fails because the coordinates are missing."""

    async def scene(terminal: Terminal, keys: PipeInput, paper: Paper) -> None:
        keys.send_text("red \x1b[31mpaint\r")
        assert await asyncio.wait_for(terminal.read(), 10) == "red paint"

    play(scene)
    assert not caplog.records


def test_each_key_calls_on_key_except_the_key_that_sends_the_line() -> None:
    count = 0

    def on_key() -> None:
        nonlocal count
        count += 1

    async def main() -> None:
        with create_pipe_input() as keys:
            async with Terminal("> ", on_key=on_key, input=keys, output=Paper()) as terminal:
                keys.send_text("abx\x7f\r")
                assert await terminal.read() == "ab"
                assert count == 4

    asyncio.run(main())


def test_a_line_of_maximum_length_accepts_no_more_keys(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(terminal_file, "LONGEST", 5)

    async def scene(terminal: Terminal, keys: PipeInput, paper: Paper) -> None:
        keys.send_text("abcdefgh\x7fxyz\r")  # the backspace key makes room for one letter
        assert await terminal.read() == "abcdx"
        keys.send_text("ab\x1b[200~cdefgh\x1b[201~ij\x1b[D\x7fk\r")
        assert await terminal.read() == "abcdefh"
        keys.send_text("abc\r")
        assert await terminal.read() == "abc"

    play(scene)


def test_lines_are_printed_in_order_with_and_without_a_prompt() -> None:
    async def scene(terminal: Terminal, keys: PipeInput, paper: Paper) -> None:
        terminal.show("one\ntwo")
        reading = asyncio.create_task(terminal.read())
        await drawn(paper)
        terminal.show("three")
        terminal.show("four")
        keys.send_text("x\r")
        await reading
        terminal.show("five")

    assert play(scene) == "one\ntwo\nthree\nfour\nfive\n"


def test_a_streamed_line_grows_above_the_prompt() -> None:
    async def scene(terminal: Terminal, keys: PipeInput, paper: Paper) -> None:
        reading = asyncio.create_task(terminal.read())
        await drawn(paper)
        terminal.stream("Hel")
        assert message(terminal) == "Hel\n> "
        await drawn(paper)
        terminal.stream("lo\nyou")
        assert message(terminal) == "you\n> "
        terminal.end()
        assert message(terminal) == "> "
        terminal.end()
        keys.send_text("x\r")
        await reading

    assert play(scene) == "Hello\nyou\n"


def test_full_rows_of_a_streamed_line_are_printed_above_the_prompt() -> None:
    async def scene(terminal: Terminal, keys: PipeInput, paper: Paper) -> None:
        terminal.stream("So long a line does not fit into the row, and nor does " + "x" * 45)
        assert message(terminal) == "xxxxxxx\n> "

    rows = ["So long a line does", "not fit into the", "row, and nor does", *["x" * 19] * 2, "x" * 7]
    assert play(scene).splitlines() == rows


@pytest.mark.parametrize(
    ("rest", "printed"),
    [(["…"], ""), ([" time"], " time\n"), ([" a ti", "me", "…"], ""), ([" a", " time"], " a time\n")],
)
def test_text_that_was_streamed_before_a_typed_line_is_not_printed_again(rest: list[str], printed: str) -> None:
    async def scene(terminal: Terminal, keys: PipeInput, paper: Paper) -> None:
        reading = asyncio.create_task(terminal.read())
        await drawn(paper)
        terminal.stream("Once upon a")
        await drawn(paper)
        keys.send_text("wait\r")
        assert await reading == "wait"
        assert message(terminal) == "> "
        for piece in rest:
            terminal.stream(piece)
        terminal.end()

    assert play(scene) == printed  # "Once upon a" is not printed again


@pytest.mark.parametrize("redirected", [False, True])
def test_standard_output_and_error_go_above_the_prompt_unless_they_are_redirected(
    monkeypatch: pytest.MonkeyPatch, redirected: bool
) -> None:
    class Stream(io.StringIO):
        def isatty(self) -> bool:
            return not redirected

    async def scene(terminal: Terminal, keys: PipeInput, paper: Paper) -> None:
        assert sys.stdout is not before
        assert sys.stderr is (stderr if redirected else sys.stdout)

    before, stderr = sys.stdout, Stream()
    monkeypatch.setattr(sys, "stderr", stderr)
    play(scene)
    assert sys.stdout is before and sys.stderr is stderr


def test_reading_ends_if_the_terminal_has_gone() -> None:
    async def scene(terminal: Terminal, keys: PipeInput, paper: Paper) -> None:
        reading = asyncio.create_task(terminal.read())
        await drawn(paper)
        paper.broken = OSError(5, "Input/output error")
        terminal.show("hello")
        with pytest.raises(EOFError):
            await reading
        with pytest.raises(EOFError):
            await terminal.read()
        with pytest.raises(BrokenPipeError):
            terminal.show("hello")

    play(scene)


def test_reading_can_be_cancelled() -> None:
    async def scene(terminal: Terminal, keys: PipeInput, paper: Paper) -> None:
        reading = asyncio.create_task(terminal.read())
        await drawn(paper)
        reading.cancel()
        with pytest.raises(asyncio.CancelledError):
            await reading
        keys.send_text("hello\r")
        assert await terminal.read() == "hello"

    play(scene)


def test_typed_lines_are_kept_in_the_history_file(tmp_path: Path) -> None:
    file = tmp_path / "state" / "history"

    async def type_it(terminal: Terminal, keys: PipeInput, paper: Paper) -> None:
        keys.send_text("hello\r")
        await terminal.read()

    async def find_it(terminal: Terminal, keys: PipeInput, paper: Paper) -> None:
        keys.send_text("\x1b[A\r")
        assert await terminal.read() == "hello"

    play(type_it, file)
    play(find_it, file)
    if os.name == "posix":
        assert file.stat().st_mode & 0o777 == 0o600


def test_a_history_file_that_cannot_be_written_causes_no_error(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    async def scene(terminal: Terminal, keys: PipeInput, paper: Paper) -> None:
        if file.is_file():  # it becomes unwritable after the start
            file.unlink()
            file.mkdir()
        for keystrokes in ("hello\r", "\x1b[A\r"):
            keys.send_text(keystrokes)
            assert await terminal.read() == "hello"

    (tmp_path / "file").touch()
    for file in (tmp_path / "file" / "history", tmp_path / "history"):
        play(scene, file)
    assert caplog.records == []


@pytest.mark.parametrize(
    ("text", "width", "rows"),
    [
        ("hello you", 8, ["hello", "you"]),
        ("hello", 4, ["hel", "lo"]),
        ("日本語", 4, ["日", "本", "語"]),
        ("日", 2, ["日"]),
    ],
)
def test_a_row_is_broken_at_a_space_or_else_at_the_edge(text: str, width: int, rows: list[str]) -> None:
    async def scene(terminal: Terminal, keys: PipeInput, paper: Paper) -> None:
        terminal.stream(text)

    assert play(scene, columns=width).splitlines() == rows


def test_a_streamed_line_appears_on_a_real_terminal() -> None:
    async def main() -> str:
        screen = io.StringIO()
        output = Screen(screen, lambda: Size(rows=40, columns=80), enable_cpr=False)
        with create_pipe_input() as keys:
            async with Terminal("> ", input=keys, output=output) as terminal:
                reading = asyncio.create_task(terminal.read())
                await drawn(output)
                terminal.stream("Hello")
                await drawn(output)
                assert "Hello" in screen.getvalue()
                assert "…" not in screen.getvalue()
                keys.send_text("x\r")
                await reading
        return screen.getvalue()

    assert "Hello…" in asyncio.run(main())  # a typed line in between ends the unfinished text with "…"
