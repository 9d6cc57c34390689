"""Ravestate runs either its compiled build or its sources. These tests show which of them runs in each case."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from ravestate import compiled

PROBE = (
    "from ravestate.compiled import build; from ravestate.engine import spike; print(build()); print(spike.__file__)"
)


def probe(**environment: str) -> tuple[str, str]:
    """Return which build a new process uses, and the suffix of the file of a module that can be compiled."""
    clean = {name: value for name, value in os.environ.items() if name != "RAVESTATE_PURE"}
    run = subprocess.run(
        [sys.executable, "-c", PROBE], env=clean | environment, capture_output=True, text=True, check=True
    )
    build, file = run.stdout.splitlines()
    return build, Path(file).suffix


def test_the_variable_ravestate_pure_makes_the_sources_run() -> None:
    assert probe(RAVESTATE_PURE="1") == (compiled.PURE, ".py")


def test_build_names_the_build_that_really_runs() -> None:
    build, suffix = probe()
    assert (build == compiled.COMPILED) == (suffix != ".py")


@pytest.fixture
def place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The folder of a package with one source that has been compiled."""
    (tmp_path / "engine").mkdir()
    (tmp_path / "engine" / "spike.py").write_text("one = 1\n")
    monkeypatch.setattr(compiled, "SOURCES", str(tmp_path))
    monkeypatch.setattr(compiled, "PLACE", str(tmp_path / "native"))
    monkeypatch.setattr(compiled, "STAMP", str(tmp_path / "stamp"))
    monkeypatch.setattr(sys.modules["ravestate"], "__path__", [str(tmp_path)])
    monkeypatch.delenv("RAVESTATE_PURE", raising=False)
    return tmp_path


def stamp(place: Path) -> None:
    (place / "stamp").write_text(f"{compiled.checksum(['engine/spike.py'])}\nengine/spike.py\n")


def test_compiled_modules_are_found_before_their_sources(place: Path) -> None:
    stamp(place)
    path = [str(place / "engine")]
    compiled.build.cache_clear()
    compiled.prefer(path)
    compiled.build.cache_clear()
    assert path == [str(place / "native" / "engine"), str(place / "engine")]


def test_changed_sources_run_instead_of_an_outdated_build(place: Path) -> None:
    stamp(place)
    (place / "engine" / "spike.py").write_text("one = 2\n")
    compiled.build.cache_clear()
    assert compiled.build() == compiled.STALE
    path = [str(place / "engine")]
    compiled.prefer(path)
    compiled.build.cache_clear()
    assert path == [str(place / "engine")]


@pytest.mark.parametrize("missing", ["stamp", "engine/spike.py"])
def test_without_a_stamp_or_a_source_the_build_counts_as_pure(place: Path, missing: str) -> None:
    stamp(place)
    (place / missing).unlink()
    compiled.build.cache_clear()
    assert compiled.build() == compiled.PURE
    compiled.build.cache_clear()
