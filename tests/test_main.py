"""The package runs as a command: ``python -m ravestate``."""

import os
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

import ravestate as rs
from ravestate import compiled


def test_python_m_ravestate_runs_the_command() -> None:
    run = subprocess.run([sys.executable, "-m", "ravestate", "--version"], capture_output=True, text=True, check=False)
    assert (run.returncode, run.stdout.strip()) == (0, f"ravestate {rs.__version__} ({compiled.build()})")


@pytest.mark.parametrize(
    ("command", "closed", "code", "says"),
    [
        ("graph rawio", ">&-", 0, ""),
        ("nlp --json", "<&-", 0, ""),
        ("memory --path FILE load -", "<&-", 2, "- is not JSON"),
    ],
)
def test_a_closed_stream_is_empty(command: str, closed: str, code: int, says: str, tmp_path: Path) -> None:
    shell = f"{shlex.quote(sys.executable)} -m ravestate {command} {closed}".replace("FILE", str(tmp_path / "m.lbug"))
    run = subprocess.run(shell, shell=True, stderr=subprocess.PIPE, text=True, check=False)
    assert run.returncode == code and says in run.stderr and "Traceback" not in run.stderr


def test_data_for_programs_is_utf_8_in_every_locale(tmp_path: Path) -> None:
    (tmp_path / "door.py").write_text(
        "import ravestate as rs\nmodule = rs.Module('door')\nrung = module.signal('rung', input=True)\n"
        "@module.rule(when=rung, weight=2)\ndef opens(ctx): pass\n",
        encoding="utf-8",
    )
    run = subprocess.run(
        [sys.executable, "-m", "ravestate", "graph", "./door.py", "--format", "mermaid"],
        cwd=tmp_path, capture_output=True, check=False, env={**os.environ, "PYTHONIOENCODING": "ascii"},
    )  # fmt: skip
    assert run.returncode == 0 and "×2" in run.stdout.decode("utf-8")


def test_text_for_people_has_question_marks_for_what_a_terminal_cannot_show() -> None:
    run = subprocess.run(
        [sys.executable, "-m", "ravestate", "nlp", "A café."],
        capture_output=True, check=False, env={**os.environ, "PYTHONIOENCODING": "ascii"},
    )  # fmt: skip
    assert run.returncode == 0 and b"normal    A caf?." in run.stdout


BUFFERED = {name: value for name, value in os.environ.items() if name != "PYTHONUNBUFFERED"}


@pytest.mark.parametrize("environment", [BUFFERED, {**BUFFERED, "PYTHONUNBUFFERED": "1"}])
@pytest.mark.parametrize("command", [["check", "rawio"], ["graph", "rawio"]])
def test_output_that_cannot_be_written_gives_a_message(command: list[str], environment: dict[str, str]) -> None:
    with Path("/dev/full").open("w") as full:
        run = subprocess.run(
            [sys.executable, "-m", "ravestate", *command],
            stdout=full, stderr=subprocess.PIPE, text=True, check=False, env=environment,
        )  # fmt: skip
    message = f"ravestate {command[0]}: the output cannot be written: No space left on device\n"
    assert (run.returncode, run.stderr) == (1, message)


@pytest.mark.parametrize("command", [["check", "rawio"], ["--help"]])
def test_a_reader_that_has_ended_is_no_error(command: list[str]) -> None:
    read, write = os.pipe()
    os.close(read)
    run = subprocess.run(
        [sys.executable, "-m", "ravestate", *command],
        stdout=write, stderr=subprocess.PIPE, text=True, check=False, env=BUFFERED,
    )  # fmt: skip
    os.close(write)
    assert (run.returncode, run.stderr) == (0, "")


INTERRUPTED = """
import sys

class Interrupt:
    def find_spec(self, name, path=None, target=None):
        if name == sys.argv[1]:
            raise KeyboardInterrupt

sys.meta_path.insert(0, Interrupt())
from ravestate.__main__ import script
sys.argv[1:] = ["check", "rawio"]
sys.exit(script())
"""


@pytest.mark.parametrize("during", ["ravestate.cli", "ravestate.cli.check"])
def test_ctrl_c_during_the_imports_gives_exit_code_130_without_a_traceback(during: str) -> None:
    program = INTERRUPTED.replace("sys.argv[1]:", f"{during!r}:")
    run = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=False)
    assert (run.returncode, run.stderr) == (130, "")
