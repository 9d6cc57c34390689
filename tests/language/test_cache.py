"""The cache of computed arrays: its size, and which files it keeps."""

import os
from pathlib import Path

import numpy as np
import pytest

from ravestate.language import cache
from ravestate.language.cache import cached


@pytest.fixture(autouse=True)
def folder(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Path:
    """An empty cache."""
    monkeypatch.setattr(cache, "user_folder", lambda kind: tmp_path)
    return tmp_path / "vectors"


def computed(key: object) -> bool:
    """Return whether the array of a key was computed, not read."""
    calls: list[object] = []
    cached(key, lambda: calls.append(key) or {"array": np.zeros(10)})
    return bool(calls)


def test_files_that_nobody_reads_any_more_are_removed(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for age, key in enumerate(("oldest", "older", "old")):
        before = set(folder.glob("*"))
        assert computed(key)
        [file] = {*folder.iterdir()} - before
        os.utime(file, (age, age))
    monkeypatch.setattr(cache, "BYTES", 3 * file.stat().st_size)
    assert not computed("oldest")  # so it is the newest now
    assert computed("new")
    assert [computed(key) for key in ("oldest", "old", "new")] == [False, False, False]
    assert computed("older")


def test_many_small_files_push_out_no_large_one() -> None:
    cached("large", lambda: {"array": np.zeros(100_000)})
    for number in range(150):
        assert computed(number)
    assert not computed("large")
    assert not computed(0)
