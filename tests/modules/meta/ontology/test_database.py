"""A damaged file causes a plain message, and ends no process."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from modules.meta.ontology.conftest import Open
from ravestate.modules.meta.ontology import database
from ravestate.modules.meta.ontology.database import survives

HERE = Path(__file__).parent


def small_memory(tmp_path: Path, open_here: Open) -> Path:
    memory = open_here(path=tmp_path / "memory.lbug")
    here = memory.create("City", name="here").result()
    for number in range(5):
        person = memory.create("Person", name=f"person {number}", nickname="x" * 100).result()
        memory.relate(person, "lives_in", here).result()
    memory.close().result()
    return tmp_path / "memory.lbug"


def test_a_damaged_file_is_read_or_called_broken(tmp_path: Path, open_here: Open) -> None:
    """Cut files, flipped bits, and pages of zeros or noise: about one in eight would end the process that opens it."""
    path, cases = small_memory(tmp_path, open_here), 16
    run = subprocess.run(
        [sys.executable, HERE / "damaged.py", path, "4", str(cases)],
        capture_output=True, text=True, check=False, timeout=300,
    )  # fmt: skip
    outcomes = run.stdout.splitlines()
    assert run.returncode == 0, run.stderr[-500:]
    assert len(outcomes) == cases
    assert set(outcomes) <= {"read", "broken"}, outcomes
    assert outcomes.count("broken") >= cases // 4


def test_a_trial_leaves_a_whole_file_as_it_is(tmp_path: Path, open_here: Open) -> None:
    path = small_memory(tmp_path, open_here)
    content = path.read_bytes()
    assert survives(path) and survives(path, whole_log=False)
    assert path.read_bytes() == content


def test_a_process_that_ends_or_takes_for_ever_does_not_survive(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(database, "PATIENCE", 2.0)
    file = tmp_path / "trial.py"
    for program, alive in (
        ("import os; os.abort()", False),
        ("raise OSError", True),
        ("import signal; signal.pause()", False),
    ):
        file.write_text(program)
        monkeypatch.setattr(database, "__file__", str(file))
        assert survives(tmp_path) is alive
