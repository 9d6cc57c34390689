"""Reading and writing lines through pipes and files. The lines can contain any bytes."""

import asyncio
import io
import os
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import TextIO

import pytest

from ravestate.modules.platform.conio.pipes import Pipes

Pipe = tuple[TextIO, TextIO]


@pytest.fixture
def pipe() -> Iterator[Callable[[], Pipe]]:
    with ExitStack() as stack:

        def make() -> Pipe:
            out, into = os.pipe()
            reader, writer = open(out), open(into, "w")  # noqa: SIM115
            stack.callback(reader.close)
            stack.callback(writer.close)
            return reader, writer

        yield make


async def all_lines(pipes: Pipes) -> list[str]:
    lines: list[str] = []
    while True:
        try:
            lines.append(await pipes.read())
        except EOFError:
            return lines


def read(file: TextIO | None, **options: int) -> list[str]:
    async def main() -> list[str]:
        async with Pipes(file, None, **options) as pipes:
            lines = await all_lines(pipes)
            with pytest.raises(EOFError):
                await pipes.read()
            return lines

    return asyncio.run(main())


@pytest.mark.parametrize(
    ("content", "lines"),
    [
        (b"", []),
        (b"hello\n", ["hello"]),
        (b"hello\r\nyou", ["hello", "you"]),
        (b"\n\n", ["", ""]),
        (b"caf\xe9 \xe2\x82\xac\n", ["caf\ufffd \u20ac"]),
        (b"a\x00b\x1b[31m\n", ["a\x00b\x1b[31m"]),
        (b"x" * 100_000 + b"\ny\n", ["x" * 100_000, "y"]),
    ],
)
def test_a_file_is_read_line_by_line(tmp_path: Path, content: bytes, lines: list[str]) -> None:
    (tmp_path / "input").write_bytes(content)
    with (tmp_path / "input").open() as file:
        assert read(file) == lines


@pytest.mark.parametrize(
    ("content", "lines"),
    [
        (b"x" * 200_000 + b"\ny\n", ["x" * 10, "y"]),
        (b"12345678901\n\n1234567890\n12345678901", ["1234567890", "", "1234567890", "1234567890"]),
        (b"x" * 200_000, ["x" * 10]),
    ],
)
def test_the_part_of_a_line_beyond_the_limit_is_dropped(tmp_path: Path, content: bytes, lines: list[str]) -> None:
    (tmp_path / "input").write_bytes(content)
    with (tmp_path / "input").open() as file:
        assert read(file, longest_line=10) == lines


def test_missing_or_closed_input_gives_no_lines(tmp_path: Path) -> None:
    assert read(None) == []
    assert read(io.StringIO("no file")) == []
    file = (tmp_path / "input").open("w+")
    file.close()
    assert read(file) == []


def test_the_method_read_returns_a_line_as_soon_as_it_arrives(pipe: Callable[[], Pipe]) -> None:
    reader, writer = pipe()

    async def main() -> None:
        async with Pipes(reader, None) as pipes:
            print("one", file=writer, flush=True)
            assert await pipes.read() == "one"
            print("two", end="", file=writer, flush=True)
            waiting = asyncio.create_task(pipes.read())
            await asyncio.sleep(0)
            assert not waiting.done()
            waiting.cancel()
            await asyncio.wait([waiting])
            print("!\nthree", file=writer)
            writer.close()
            assert await all_lines(pipes) == ["two!", "three"]  # the cancelled read has lost nothing

    asyncio.run(main())


def test_the_input_can_end_after_the_event_loop_has_ended(pipe: Callable[[], Pipe]) -> None:
    reader, writer = pipe()

    async def main() -> None:
        async with Pipes(reader, None) as pipes:
            waiting = asyncio.create_task(pipes.read())
            await asyncio.sleep(0)
            waiting.cancel()

    asyncio.run(main())
    writer.close()


def test_the_method_show_writes_lines_immediately(pipe: Callable[[], Pipe]) -> None:
    reader, writer = pipe()
    pipes = Pipes(None, writer)
    pipes.show("hello\nyou")
    assert [reader.readline(), reader.readline()] == ["hello\n", "you\n"]


def test_a_streamed_line_is_written_when_it_is_complete() -> None:
    out = io.StringIO()
    pipes = Pipes(None, out)
    pipes.stream("Hel")
    assert out.getvalue() == ""
    pipes.stream("lo\nyo")
    assert out.getvalue() == "Hello\n"
    pipes.end()
    assert out.getvalue() == "Hello\nyo\n"


def test_a_terminal_immediately_shows_each_piece() -> None:
    class Terminal(io.StringIO):
        def isatty(self) -> bool:
            return True

    out = Terminal()
    pipes = Pipes(None, out)
    pipes.stream("Hel")
    assert out.getvalue() == "Hel"
    pipes.stream("lo")
    pipes.end()
    assert out.getvalue() == "Hello\n"


def test_characters_that_the_encoding_lacks_are_replaced() -> None:
    raw = io.BytesIO()
    out = io.TextIOWrapper(raw, encoding="ascii")
    Pipes(None, out).show("café 😊")
    assert raw.getvalue() == b"caf? ?\n"


def test_output_to_a_closed_pipe_raises_broken_pipe_error(pipe: Callable[[], Pipe]) -> None:
    with pytest.raises(BrokenPipeError):
        Pipes(None, None).show("hello")
    reader, writer = pipe()
    reader.close()
    pipes = Pipes(None, writer)
    with pytest.raises(BrokenPipeError):
        pipes.show("hello")
    with pytest.raises(BrokenPipeError):  # closing tries to write the rest, which fails as well
        writer.close()
