"""Agents in files for the tests of the commands, and helpers that call a command."""

import textwrap
from pathlib import Path

import pytest

from ravestate.cli import main

HELLO = """
    import ravestate as rs

    class Settings(rs.Settings):
        greeting: str = "Hello"
        pause: float = 1.0
        words: tuple[str, ...] = ()

    hello = rs.Module("hello", settings=Settings)
    said = hello.slot("said", "")

    @hello.rule(when=rs.startup, writes=said)
    async def greet(ctx):
        ctx[said] = ctx.settings.greeting
        print(ctx.settings.greeting, ctx.settings.pause, ctx.settings.words, round(ctx.random.random(), 6), flush=True)
        ctx.stop()
"""


def write(path: Path, text: str) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(textwrap.dedent(text), encoding="utf-8")
    return path


def complaints(errors: str) -> str:
    """Return the error output without the warnings that a busy machine causes."""
    return "".join(line for line in errors.splitlines(keepends=True) if "blocked the loop" not in line)


def call(capsys: pytest.CaptureFixture[str], *arguments: str) -> tuple[int, str, str]:
    """Call the command line; return its exit code, output and error output. A traceback fails the test."""
    try:
        code = main(arguments)
    except SystemExit as ended:  # argparse raises it
        assert isinstance(ended.code, int)
        code = ended.code
    out, errors = capsys.readouterr()
    assert "Traceback" not in errors
    return code, out, errors
