"""The cache of computed arrays limits its size, removes unused files, and replaces broken files."""

import errno
import os
from pathlib import Path

import numpy as np
import pytest

from ravestate.language import cache
from ravestate.language.cache import cached, mapped


@pytest.fixture(autouse=True)
def folder(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Path:
    """The folder of an empty cache."""
    monkeypatch.setattr(cache, "user_folder", lambda kind: tmp_path)
    return tmp_path / "vectors"


def computed(key: object) -> bool:
    """Return whether the array of a key had to be computed, because it was not in the cache."""
    calls: list[object] = []
    cached(key, lambda: calls.append(key) or {"array": np.zeros(10)})
    return bool(calls)


def test_the_file_that_was_read_least_recently_is_removed(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for age, key in enumerate(("oldest", "older", "old")):
        before = set(folder.glob("*"))
        assert computed(key)
        [file] = {*folder.iterdir()} - before
        os.utime(file, (age, age))
    monkeypatch.setattr(cache, "BYTES", 3 * file.stat().st_size)
    assert not computed("oldest")  # this read makes its file the newest
    assert computed("new")
    assert [computed(key) for key in ("oldest", "old", "new")] == [False, False, False]
    assert computed("older")


def test_many_small_files_do_not_displace_a_large_file() -> None:
    cached("large", lambda: {"array": np.zeros(100_000)})
    for number in range(150):
        assert computed(number)
    assert not computed("large")
    assert not computed(0)


def test_a_memory_map_reads_the_file_that_the_first_call_has_written() -> None:
    calls: list[int] = []

    def compute() -> np.ndarray:
        calls.append(1)
        return np.arange(6).reshape(2, 3)

    first, again = mapped("map", compute), mapped("map", compute)
    assert len(calls) == 1
    assert isinstance(again, np.memmap)
    assert (first == again).all()


@pytest.mark.parametrize("damage", ["short", "header", "zip", "data"])
def test_a_broken_memory_map_is_computed_again(folder: Path, damage: str) -> None:
    mapped("map", lambda: np.arange(6))
    [file] = folder.glob("*.npy")
    good = file.read_bytes()
    bad = {
        "short": good[:-8],
        "header": good.replace(b"{", b"("),
        "zip": b"PK" + good[2:],
        "data": good[:-8] + bytes(8),
    }
    file.write_bytes(bad[damage])
    assert mapped("map", lambda: np.arange(6)).tolist() == list(range(6))
    assert file.read_bytes() == good


def test_a_broken_file_is_computed_again(folder: Path) -> None:
    assert computed("key")
    [file] = folder.iterdir()
    file.write_bytes(file.read_bytes().replace(b"{", b"("))
    assert computed("key")
    assert not computed("key")


def test_a_write_that_fails_leaves_no_file(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*_: object, **__: object) -> None:
        raise OSError(errno.ENOSPC, "no space left on device")

    monkeypatch.setattr(np, "save", full)
    assert mapped("map", lambda: np.arange(6)).tolist() == list(range(6))
    assert list(folder.iterdir()) == []


def test_a_file_that_another_process_removes_meanwhile_causes_no_error(monkeypatch: pytest.MonkeyPatch) -> None:
    def gone(_: Path) -> None:
        raise FileNotFoundError

    monkeypatch.setattr(os, "scandir", gone)
    mapped("map", lambda: np.arange(6))
    assert isinstance(mapped("map", lambda: np.arange(6)), np.memmap)


def test_an_array_that_cannot_be_written_to_the_cache_is_computed_only_once(folder: Path) -> None:
    folder.write_text("a file in the place of the folder")
    calls: list[int] = []
    for _ in range(2):
        assert mapped("map", lambda: calls.append(1) or np.arange(6)).tolist() == list(range(6))
    assert len(calls) == 1
