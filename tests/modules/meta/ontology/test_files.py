"""Memory finds all its files, and makes them readable only by the user."""

from __future__ import annotations

import os
import shutil
import stat
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from modules.meta.ontology.conftest import Open
from ravestate.modules.meta.ontology import embedded
from ravestate.modules.meta.ontology.files import MemoryFiles

HERE = Path(__file__).parent
SIDE_FILES = [
    "memory.lbug.checkpoint.apply.lock",
    "memory.lbug.new",
    "memory.lbug.new.wal.checkpoint",
    "memory.lbug.probe",
    "memory.lbug.shadow",
    "memory.lbug.sum",
    "memory.lbug.wal",
    "memory.lbug.wal.checkpoint",
    "memory.lbug.wal.damaged-1",
    "memory.lbug.wal.orphaned-12",
]


@pytest.fixture
def crashed(tmp_path: Path) -> Path:
    """A memory whose process was killed: the names are in the log."""
    path = tmp_path / "memory.lbug"
    command = [sys.executable, HERE / "writer.py", path]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True, umask=0o022) as process:
        assert process.stdout is not None and process.stdout.readline() == "0\n"
        process.kill()
    assert b"person 0" in Path(f"{path}.wal").read_bytes()
    return path


def modes(folder: Path) -> dict[str, int]:
    return {file.name: stat.S_IMODE(file.stat().st_mode) for file in folder.iterdir()}


def test_files_of_memory_are_known_by_name_and_others_are_left_out(tmp_path: Path) -> None:
    for name in [
        *SIDE_FILES,
        "memory.lbug",
        "memory.lbug.backup",
        "memory.lbug2",
        "memory.lbug.wal.bak",
        "x.wal",
    ]:
        (tmp_path / name).touch()
    files = MemoryFiles(tmp_path / "memory.lbug")
    assert [file.name for file in files.present()] == ["memory.lbug", *SIDE_FILES]
    assert [file.name for file in files.kept()] == SIDE_FILES[-2:]
    assert len(files.remove()) == len(SIDE_FILES) + 1
    assert sorted(modes(tmp_path)) == ["memory.lbug.backup", "memory.lbug.wal.bak", "memory.lbug2", "x.wal"]
    assert files.present() == [] == MemoryFiles(tmp_path / "none" / "memory.lbug").present()


def test_a_file_that_is_set_aside_replaces_no_earlier_file(tmp_path: Path) -> None:
    files = MemoryFiles(tmp_path / "memory.lbug")
    for number in (1, 2):
        files.log.write_text(str(number))
        [kept] = files.set_aside(files.logs(), "orphaned")
        assert kept.name == f"memory.lbug.wal.orphaned-{number}" and kept.read_text() == str(number)
    assert files.logs() == [] and len(files.kept()) == 2


def test_the_log_is_readable_only_by_the_user_from_its_first_byte(crashed: Path) -> None:
    assert modes(crashed.parent) == {"memory.lbug": 0o600, "memory.lbug.wal": 0o600}


def test_only_the_user_may_read_the_files_that_memory_creates(
    tmp_path: Path, open_here: Open, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The test looks before and after each statement, because ladybug keeps the mode of an existing file."""
    seen: dict[str, int] = {}
    connect = embedded.connect

    class Watched:
        def __init__(self, connection: Any) -> None:
            self.close = connection.close
            self._connection = connection

        def execute(self, *statement: Any) -> Any:
            seen.update(modes(tmp_path))
            result = self._connection.execute(*statement)
            seen.update(modes(tmp_path))
            return result

    def watch(*arguments: Any, **options: Any) -> tuple[Any, Any]:
        database, connection = connect(*arguments, **options)
        return database, Watched(connection)

    monkeypatch.setattr(embedded, "connect", watch)
    before = os.umask(0o022)
    try:
        memory = open_here(path=tmp_path / "memory.lbug")
        ada = memory.create("Person", name="Ada").result()
        memory.forget(ada).result()
        memory.create("Person", name="Bob").result()
        memory.close().result()
        seen.update(modes(tmp_path))
    finally:
        os.umask(before)
    whole = {"memory.lbug", "memory.lbug.wal", "memory.lbug.shadow", "memory.lbug.sum"}
    assert whole | {"memory.lbug.new", "memory.lbug.new.wal", "memory.lbug.new.shadow"} <= set(seen)
    assert set(seen.values()) == {0o600}, seen


def test_files_of_an_earlier_version_become_readable_only_by_the_user(crashed: Path, open_here: Open) -> None:
    for file in crashed.parent.iterdir():
        file.chmod(0o644)
    open_here(path=crashed)
    assert set(modes(crashed.parent).values()) == {0o600}


def test_the_log_of_a_deleted_memory_is_set_aside_and_a_warning_names_it(
    crashed: Path, open_here: Open, caplog: pytest.LogCaptureFixture
) -> None:
    crashed.unlink()
    memory = open_here(path=crashed)
    assert memory.find("Person").result() == []
    kept = Path(f"{crashed}.wal.orphaned-1")
    assert b"person 0" in kept.read_bytes() and str(kept) in caplog.text
    assert f"ravestate memory reset --path {crashed}" in caplog.text
    memory.create("Person", name="Ada").result()
    memory.close().result()
    assert [node["name"] for node in open_here(path=crashed).find("Person").result()] == ["Ada"]


def test_the_log_of_another_memory_is_set_aside(
    crashed: Path, tmp_path: Path, open_here: Open, caplog: pytest.LogCaptureFixture
) -> None:
    """An earlier version could leave a new database beside the log of a deleted database."""
    other = open_here(path=tmp_path / "other" / "memory.lbug")
    other.create("Person", name="Ada").result()
    other.close().result()
    shutil.copy(tmp_path / "other" / "memory.lbug", crashed)
    assert [node["name"] for node in open_here(path=crashed).find("Person").result()] == ["Ada"]
    assert f"{crashed}.wal.orphaned-1" in caplog.text


def test_an_unfinished_rewrite_of_a_deleted_memory_is_set_aside(tmp_path: Path, open_here: Open) -> None:
    for name in ("memory.lbug.new", "memory.lbug.new.wal"):
        (tmp_path / name).write_bytes(b"Ada")
    open_here(path=tmp_path / "memory.lbug")
    assert (tmp_path / "memory.lbug.new.orphaned-1").read_bytes() == b"Ada"
    assert (tmp_path / "memory.lbug.new.wal.orphaned-1").exists()


def test_an_unfinished_rewrite_is_removed_at_the_next_opening(tmp_path: Path, open_here: Open) -> None:
    open_here(path=tmp_path / "memory.lbug").close().result()
    for name in ("memory.lbug.new", "memory.lbug.new.wal.checkpoint", "memory.lbug.new.shadow"):
        (tmp_path / name).write_bytes(b"Ada")
    open_here(path=tmp_path / "memory.lbug")
    assert not any(b"Ada" in file.read_bytes() for file in tmp_path.iterdir())


def test_forget_warns_about_logs_that_can_still_have_the_data(
    crashed: Path, open_here: Open, caplog: pytest.LogCaptureFixture
) -> None:
    crashed.unlink()
    memory = open_here(path=crashed)
    ada = memory.create("Person", name="Ada").result()
    caplog.clear()
    memory.forget(ada).result()
    assert "may still have data of the forgotten nodes" in caplog.text
    assert f"{crashed}.wal.orphaned-1" in caplog.text


def test_closing_seals_a_memory_and_a_later_change_breaks_the_seal(tmp_path: Path, open_here: Open) -> None:
    """The seal is a checksum in the file ``memory.lbug.sum``."""
    files = MemoryFiles(tmp_path / "memory.lbug")
    assert not files.is_sealed()
    open_here(path=files.path).close().result()
    assert files.is_sealed()
    with files.path.open("ab") as file:
        file.write(b"\0")
    assert not files.is_sealed()


def test_closing_leaves_no_empty_files(tmp_path: Path, open_here: Open) -> None:
    open_here(path=tmp_path / "memory.lbug").close().result()
    assert sorted(modes(tmp_path)) == ["memory.lbug", "memory.lbug.sum"]
