"""Purging removes all bytes of forgotten nodes from the file. `unrelate` does not wait for the purge; `forget` does."""

from __future__ import annotations

import logging
import subprocess
import sys
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from modules.meta.ontology.conftest import Open
from modules.meta.ontology.replacing import NEVER, OLD, replaced
from ravestate.modules import ontology
from ravestate.modules.meta.ontology import embedded, worker
from ravestate.modules.meta.ontology.embedded import EmbeddedStore

HERE = Path(__file__).parent


def holds(path: Path, trace: bytes = OLD.encode()) -> bool:
    """Return whether a file of the memory has these bytes."""
    return any(trace in file.read_bytes() for file in path.parent.iterdir())


@pytest.fixture
def rewrites(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Return a list to which each rewriting of a file adds the word *copied*."""
    done: list[str] = []
    copy = embedded.copy_database

    def note(*databases: Any) -> None:
        done.append("copied")
        copy(*databases)

    monkeypatch.setattr(embedded, "copy_database", note)
    return done


@pytest.fixture
def rests(monkeypatch: pytest.MonkeyPatch) -> threading.Semaphore:
    """Return a semaphore that is released after each call of `EmbeddedStore.rest`."""
    done = threading.Semaphore(0)
    rest = EmbeddedStore.rest

    def note(store: EmbeddedStore) -> None:
        rest(store)
        done.release()

    monkeypatch.setattr(EmbeddedStore, "rest", note)
    return done


def test_a_replaced_value_is_purged_from_the_file_in_the_first_pause(
    tmp_path: Path, open_here: Open, rests: threading.Semaphore, rewrites: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(worker, "PAUSE", NEVER)
    path = tmp_path / "memory.lbug"
    memory = open_here(path=path)
    ada, new = replaced(memory)
    assert rewrites == []  # the operation has ended before the purge
    assert holds(path)
    monkeypatch.setattr(worker, "PAUSE", 0.01)
    memory.get(ada.id).result()
    assert rests.acquire(timeout=60)
    assert rewrites == ["copied"]
    assert not holds(path)
    assert memory.related(ada, "lives_in").result() == [new]
    assert rests.acquire(timeout=60)
    assert rewrites == ["copied"]  # a pause with nothing to purge rewrites nothing


def test_without_a_pause_the_purge_is_still_done_in_time(
    tmp_path: Path, open_here: Open, rests: threading.Semaphore, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(worker, "PAUSE", NEVER)
    memory = open_here(path=tmp_path / "memory.lbug")
    replaced(memory)
    monkeypatch.setattr(worker, "LONGEST", 0.0)
    memory.find("City").result()
    assert rests.acquire(timeout=60)
    assert not holds(tmp_path / "memory.lbug")


def test_the_operation_purge_returns_when_no_byte_of_the_old_value_is_left(
    tmp_path: Path, open_here: Open, rewrites: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(worker, "PAUSE", NEVER)
    path = tmp_path / "memory.lbug"
    memory = open_here(path=path)
    replaced(memory)
    memory.purge().result()
    assert not holds(path)
    memory.purge().result()
    assert rewrites == ["copied"]


def test_closing_a_memory_purges_it(tmp_path: Path, open_here: Open, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(worker, "PAUSE", NEVER)
    path = tmp_path / "memory.lbug"
    memory = open_here(path=path)
    replaced(memory)
    assert holds(path)
    memory.close().result()
    assert not holds(path)


@pytest.fixture
def killed(tmp_path: Path) -> Iterator[Path]:
    """A memory whose process was killed after a value was replaced, and before the purge."""
    path = tmp_path / "memory.lbug"
    command = [sys.executable, HERE / "replacing.py", path]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None and process.stdout.readline() == "replaced\n"
        process.kill()
    yield path


def test_a_purge_that_a_kill_prevented_is_done_after_the_next_start(
    killed: Path, open_here: Open, rests: threading.Semaphore, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert holds(killed)
    monkeypatch.setattr(worker, "PAUSE", 0.01)
    memory = open_here(path=killed)
    memory.find("City").result()
    # The first call of `rest` can come before the types are read. The second call comes after a pause.
    assert rests.acquire(timeout=60) and (not holds(killed) or rests.acquire(timeout=60))
    assert not holds(killed)
    assert [city["name"] for city in memory.find("City").result()] == ["London"]


def test_a_failed_purge_is_repeated_after_the_next_start(
    killed: Path, open_here: Open, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    def fail(*_: object) -> None:
        raise OSError("no more space")

    monkeypatch.setattr(embedded, "copy_database", fail)
    open_here(path=killed).close().result()
    assert "the file still has their bytes: no more space" in caplog.text
    assert holds(killed)
    monkeypatch.undo()
    caplog.clear()
    open_here(path=killed).close().result()
    assert not holds(killed)
    assert not [record for record in caplog.records if record.levelno >= logging.WARNING]


@pytest.mark.parametrize("ending", ["purge", "close"])
def test_the_operations_purge_and_close_repeat_a_failed_purge_but_pauses_do_not(
    tmp_path: Path,
    open_here: Open,
    rests: threading.Semaphore,
    rewrites: list[str],
    monkeypatch: pytest.MonkeyPatch,
    ending: str,
) -> None:
    def fail(*_: object) -> None:
        rewrites.append("copied")
        raise OSError("no more space")

    path = tmp_path / "memory.lbug"
    memory = open_here(path=path)
    person, _ = (memory.create("Person", name=name).result() for name in (OLD, "Bob"))
    memory.tidy().result()
    with monkeypatch.context() as patched:
        patched.setattr(embedded, "copy_database", fail)
        memory.forget(person).result()
        monkeypatch.setattr(worker, "PAUSE", 0.01)
        for _ in range(2):
            memory.find("City").result()
            assert rests.acquire(timeout=60)
        assert rewrites == ["copied"]  # otherwise, each pause would log a warning
    monkeypatch.setattr(worker, "PAUSE", NEVER)
    assert holds(path)
    (memory.purge() if ending == "purge" else memory.close()).result()
    assert not holds(path)


def test_a_deletion_that_is_rolled_back_causes_no_purge(
    tmp_path: Path, open_here: Open, rewrites: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(worker, "PAUSE", NEVER)
    memory = open_here(path=tmp_path / "memory.lbug")
    ada = memory.create("Person", name="Ada").result()

    def forget_and_fail(graph: ontology.Graph) -> None:
        graph.forget(ada)
        raise ValueError

    with pytest.raises(ValueError):  # the operation's own error
        memory.together(forget_and_fail).result()
    memory.close().result()
    assert rewrites == []
    assert open_here(path=tmp_path / "memory.lbug").get(ada.id).result() == ada
