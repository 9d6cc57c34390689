"""The whole command line: help and exit codes. A user's mistake never gives a traceback."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

import ravestate as rs
from cli.examples import HELLO, call, complaints, write
from ravestate import compiled
from ravestate.cli import COMMANDS, main
from ravestate.modules import BUILT_IN

Capture = pytest.CaptureFixture[str]


def test_every_command_has_help(capsys: Capture) -> None:
    code, out, _ = call(capsys, "--help")
    assert code == 0
    for name, summary in COMMANDS.items():
        assert name in out and summary.split(",")[0][:30] in " ".join(out.split())
        code, own, _ = call(capsys, name, "--help")
        assert code == 0 and own.startswith(f"usage: ravestate {name}")


@pytest.mark.parametrize("arguments", [("--help",), ("run", "--help")])
def test_help_lists_the_built_in_modules_and_imports_none(arguments: tuple[str, ...], folder: Path) -> None:
    program = (
        "import sys\n"
        "from ravestate.cli import main\n"
        "try: main(sys.argv[1:])\n"
        "finally: print([m for m in sys.modules if m.startswith('ravestate.modules.')])"
    )
    run = subprocess.run(
        [sys.executable, "-c", program, *arguments], capture_output=True, text=True, timeout=60, check=False
    )
    listed = run.stdout.partition("built-in modules:\n")[2].splitlines()
    told = dict(line.split(maxsplit=1) for line in listed if re.match(r"  \w", line))
    assert list(told) == sorted(BUILT_IN)
    assert all(len(summary) > 10 for summary in told.values())
    assert run.stdout.splitlines()[-1] == "[]"


def test_the_command_prints_its_version(capsys: Capture) -> None:
    assert call(capsys, "--version") == (0, f"ravestate {rs.__version__} ({compiled.build()})\n", "")


@pytest.mark.parametrize("arguments", [(), ("rnu",), ("run", "--nonsense", "idle"), ("run", "idle", "--seed", "x")])
def test_wrong_use_gives_exit_code_2(arguments: tuple[str, ...], capsys: Capture) -> None:
    code, out, errors = call(capsys, *arguments)
    assert (code, out) == (2, "") and errors.startswith("usage: ravestate")


def test_a_misspelt_command_has_a_hint(capsys: Capture) -> None:
    code, _, errors = call(capsys, "chatt")
    assert code == 2 and errors.endswith("error: there is no command 'chatt'; did you mean 'chat'?\n")


def test_options_cannot_be_abbreviated(capsys: Capture) -> None:
    code, _, errors = call(capsys, "run", "idle", "--see", "1")
    assert code == 2 and "--see" in errors


def test_modules_can_come_before_and_after_options(folder: Path, capsys: Capture) -> None:
    write(folder / "hello.py", HELLO)
    code, out, errors = call(capsys, "check", "idle", "--set", "idle.bored_after=9", "./hello.py", "fillers")
    assert (code, errors) == (0, "")
    assert out == call(capsys, "check", "idle", "./hello.py", "fillers")[1]


@pytest.mark.parametrize(
    ("arguments", "usage", "complaint"),
    [
        (("run", "idle", "--nonsense"), "run", "unrecognized arguments: --nonsense"),
        (("run", "idle", "--sed=1"), "run", "unrecognized arguments: --sed=1; did you mean '--se"),
        (("memory", "list", "--pth", "x"), "memory list", "--pth; did you mean '--path'?"),
        (("board", "./guide.py", "--port", "8420"), "board", "--port 8420; write --set webio.port=8420"),
        (("board", "--port", "80", "--host", "::1"), "board", "write --set webio.port=80"),
        (("board", "--port"), "board", "write --set webio.port=PORT"),
        (("board", "--host=0.0.0.0"), "board", "--host=0.0.0.0; write --set webio.host=0.0.0.0"),
        (("genqa", "list", "extra"), "genqa list", "unrecognized arguments: extra"),
        (("genqa", "--nonsense", "list"), "genqa", "unrecognized arguments: --nonsense"),
        (("memory", "--nonsense=1", "list"), "memory", "unrecognized arguments: --nonsense=1"),
    ],
)
def test_wrong_use_of_a_command_shows_its_usage(
    arguments: tuple[str, ...], usage: str, complaint: str, capsys: Capture
) -> None:
    code, out, errors = call(capsys, *arguments)
    assert (code, out) == (2, "")
    assert errors.startswith(f"usage: ravestate {usage} [-h]")
    assert f"\nravestate {usage}: error: " in errors and complaint in errors


@pytest.mark.parametrize("flags", [(), ("-v",), ("-vv",)])
def test_the_flag_v_can_be_repeated(flags: tuple[str, ...], capsys: Capture) -> None:
    assert call(capsys, *flags, "check", "rawio")[0] == 0


def test_ctrl_c_gives_exit_code_130(monkeypatch: pytest.MonkeyPatch) -> None:
    from ravestate.cli import check

    def interrupted(options: object) -> int:
        raise KeyboardInterrupt

    monkeypatch.setattr(check, "run", interrupted)
    assert main(["check", "rawio"]) == 130


def test_a_closed_pipe_is_not_an_error(monkeypatch: pytest.MonkeyPatch) -> None:
    from ravestate.cli import check

    def broken(options: object) -> int:
        raise BrokenPipeError

    monkeypatch.setattr(check, "run", broken)
    assert main(["check", "rawio"]) == 0


def test_a_platform_error_gives_exit_code_1(monkeypatch: pytest.MonkeyPatch, capsys: Capture) -> None:
    from ravestate.cli import check

    def fails(options: object) -> int:
        raise rs.PlatformError("the microphone is gone")

    monkeypatch.setattr(check, "run", fails)
    assert call(capsys, "check", "rawio") == (1, "", "ravestate check: the microphone is gone\n")


def test_ravestate_is_installed_as_a_command(folder: Path) -> None:
    write(folder / "hello.py", HELLO)
    command = Path(sys.executable).parent / "ravestate"
    run = subprocess.run([command, "run", "./hello.py"], capture_output=True, text=True, timeout=60, check=False)
    assert (run.returncode, complaints(run.stderr)) == (0, "") and run.stdout.startswith("Hello 1.0")


def test_warnings_reach_the_user(folder: Path) -> None:
    write(
        folder / "failing.py",
        """
        import ravestate as rs
        module = rs.Module("failing")

        @module.rule(when=rs.startup)
        async def fail(ctx):
            ctx.stop()
            raise ValueError("broken")
        """,
    )
    command = Path(sys.executable).parent / "ravestate"
    run = subprocess.run([command, "run", "./failing.py"], capture_output=True, text=True, timeout=60, check=False)
    assert run.returncode == 0
    assert "ERROR ravestate: rule failing:fail failed: broken" in run.stderr
    assert run.stderr.count("Traceback") == 1  # the traceback of the rule
