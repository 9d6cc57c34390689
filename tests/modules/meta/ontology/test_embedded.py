"""Memory in a file survives kills and full disks, and reports damage clearly."""

from __future__ import annotations

import json
import os
import shutil
import stat
import subprocess
import sys
from collections.abc import Iterator
from datetime import date
from pathlib import Path
from typing import Any

import ladybug
import pytest

from modules.meta.ontology.conftest import Open
from ravestate.errors import PlatformError, RuleError
from ravestate.modules import ontology
from ravestate.modules.meta.ontology import database, embedded
from ravestate.modules.meta.ontology.opening import open_memory

HERE = Path(__file__).parent


def failure(**settings: Any) -> str:
    """Return the reason why memory cannot be opened."""
    memory = open_memory(ontology.Settings(**settings))
    with pytest.raises(PlatformError) as caught:
        memory.opened().result(60)
    memory.close().result(60)
    return str(caught.value)


@pytest.fixture
def file(tmp_path: Path, open_here: Open) -> Path:
    """A closed memory file with the person Ada."""
    path = tmp_path / "memory.lbug"
    memory = open_here(path=path)
    memory.create("Person", name="Ada").result()
    memory.close().result()
    return path


@pytest.fixture
def writer(tmp_path: Path) -> Iterator[tuple[Path, subprocess.Popen[str]]]:
    """A process that writes to a memory file."""
    path = tmp_path / "memory.lbug"
    process = subprocess.Popen([sys.executable, HERE / "writer.py", path], stdout=subprocess.PIPE, text=True)
    with process:
        yield path, process
        process.kill()


@pytest.mark.parametrize("writes", [1, 7, 300])
def test_acknowledged_writes_survive_a_kill(
    writer: tuple[Path, subprocess.Popen[str]], open_here: Open, writes: int
) -> None:
    path, process = writer
    assert process.stdout is not None
    for _ in range(writes):
        process.stdout.readline()
    process.kill()
    acknowledged = writes + len(process.stdout.readlines())
    process.wait()
    memory = open_here(path=path)
    [here] = memory.find("City").result()
    names = [node["name"] for node in memory.related(here, "lives_in", back=True).result()]
    assert names[:acknowledged] == [f"person {number}" for number in range(acknowledged)]
    assert len(names) <= acknowledged + 1  # one more write can be on disk without being acknowledged yet
    assert memory.create("Person", name="after").result()["name"] == "after"


@pytest.mark.parametrize("times", [1, 4, 9])
def test_a_kill_during_forget_neither_restores_forgotten_people_nor_loses_others(
    tmp_path: Path, open_here: Open, times: int
) -> None:
    path = tmp_path / "memory.lbug"
    with subprocess.Popen(
        [sys.executable, HERE / "writer.py", path, "forget"], stdout=subprocess.PIPE, text=True
    ) as process:
        assert process.stdout is not None
        for _ in range(times):
            process.stdout.readline()
        process.kill()
        last = times - 1 + len(process.stdout.readlines())
    memory = open_here(path=path)
    [here] = memory.find("City").result()
    names = [node["name"] for node in memory.related(here, "lives_in", back=True).result()]
    assert f"person {last}" in names or f"person {last + 1}" in names
    assert set(names) <= {f"person {last}", f"person {last + 1}"}


def test_a_second_process_learns_which_process_has_the_file(
    writer: tuple[Path, subprocess.Popen[str]],
) -> None:
    path, process = writer
    assert process.stdout is not None and process.stdout.readline() == "0\n"
    said = failure(path=path)
    assert f"memory {path} is in use by process {process.pid}" in said
    assert "--set ontology.path=FILE" in said


def test_opening_a_file_that_this_process_has_open_runs_no_statement(
    tmp_path: Path, open_here: Open, monkeypatch: pytest.MonkeyPatch
) -> None:
    memory = open_here(path=tmp_path / "memory.lbug")
    asked: list[str] = []
    execute = ladybug.Connection.execute

    def note(connection: ladybug.Connection, statement: str, *parameters: Any) -> Any:
        asked.append(statement)
        return execute(connection, statement, *parameters)

    monkeypatch.setattr(ladybug.Connection, "execute", note)
    open_here(path=tmp_path / "memory.lbug").opened().result()
    assert asked == []
    memory.create("Person", name="Ada").result()
    assert asked != []


def test_a_process_opens_a_file_once_even_under_several_paths(tmp_path: Path, open_here: Open) -> None:
    (tmp_path / "link").symlink_to(tmp_path, target_is_directory=True)
    first = open_here(path=tmp_path / "memory.lbug")
    second = open_here(path=tmp_path / "link" / ".." / tmp_path.name / "memory.lbug")
    ada = first.create("Person", name="Ada").result()
    assert second.find("Person").result() == [ada]
    first.close().result()
    second.update(ada, age=36).result()  # the file stays open until its last user closes it
    second.close().result()
    assert open_here(path=tmp_path / "memory.lbug").get(ada.id).result() == ada.with_properties(age=36)


@pytest.mark.parametrize("ending", ["full", "room"])
def test_a_full_disk_raises_an_error_and_loses_no_data(tmp_path: Path, open_here: Open, ending: str) -> None:
    path = tmp_path / "memory.lbug"
    run = subprocess.run(
        [sys.executable, HERE / "full_disk.py", path, ending],
        capture_output=True, text=True, check=False, timeout=60,
    )  # fmt: skip
    assert run.returncode == 0, run.stderr
    told = json.loads(run.stdout)
    assert len(told["errors"]) == 3
    for error in told["errors"]:
        assert f"memory {path} cannot be written" in error and "Make room on the disk" in error
    assert told["read"] == len(told["acknowledged"])
    found = [node["name"] for node in open_here(path=path).find("Person").result()]
    assert [name for name in found if name in told["acknowledged"]] == told["acknowledged"]
    assert len(found) <= len(told["acknowledged"]) + 1


def test_nothing_is_written_when_the_disk_is_almost_full(
    file: Path, open_here: Open, monkeypatch: pytest.MonkeyPatch
) -> None:
    memory = open_here(path=file)
    usage = shutil.disk_usage(file.parent)
    monkeypatch.setattr(shutil, "disk_usage", lambda _: usage._replace(free=embedded.RESERVE - 1))
    for write in (lambda: memory.create("Person"), lambda: memory.ensure("City", name="x")):
        with pytest.raises(PlatformError, match="the disk is full"):
            write().result()
    assert len(memory.find("Person").result()) == 1
    memory.close().result()
    assert "the disk is full" in failure(path=file.with_name("new.lbug"))
    memory = open_here(path=file)  # reading still works
    assert len(memory.find("Person").result()) == 1
    monkeypatch.undo()
    memory.create("Person", name="Bob").result()
    assert len(memory.find("Thing").result()) == 2


def test_a_long_log_is_moved_into_the_file(tmp_path: Path, open_here: Open, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(embedded, "LOG_LIMIT", 50_000)
    path = tmp_path / "memory.lbug"
    memory = open_here(path=path)
    sizes: list[int] = []
    for number in range(60):
        memory.create("Person", name=f"{number}" * 1000).result()
        sizes.append(os.path.getsize(f"{path}.wal") if Path(f"{path}.wal").exists() else 0)
    assert max(sizes) < 60_000 and sizes.count(0) >= 1
    memory.close().result()
    assert not Path(f"{path}.wal").exists()
    assert len(open_here(path=path).find("Person").result()) == 60


def test_a_log_that_cannot_be_moved_is_kept(
    tmp_path: Path, open_here: Open, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    path = tmp_path / "memory.lbug"
    memory = open_here(path=path)
    memory.create("Person", name="Ada").result()
    usage = shutil.disk_usage(tmp_path)
    monkeypatch.setattr(shutil, "disk_usage", lambda _: usage._replace(free=0))
    memory.close().result()
    assert f"memory {path} keeps a log" in caplog.text
    monkeypatch.undo()
    assert len(open_here(path=path).find("Person").result()) == 1


def test_a_file_of_a_newer_version_of_ladybug_is_refused_and_not_changed(file: Path) -> None:
    newer = bytearray(file.read_bytes())
    newer[4] = 200  # the version of ladybug's format
    file.write_bytes(newer)
    said = failure(path=file)
    assert "was written by a newer version of ladybug (format 200; " in said
    assert "pip install --upgrade ladybug" in said and "Nothing was changed" in said
    assert file.read_bytes() == newer


@pytest.mark.parametrize("content", [b"no database at all " * 300, b"x", None])
def test_a_broken_file_is_refused_and_not_changed(file: Path, content: bytes | None) -> None:
    broken = file.read_bytes()[:9000] if content is None else content
    file.write_bytes(broken)
    said = failure(path=file)
    assert f"memory {file} is damaged, or is not a memory file" in said and "Nothing was changed" in said
    assert file.read_bytes() == broken


def test_a_file_that_lost_all_its_tables_is_refused_and_not_changed(file: Path) -> None:
    content = file.read_bytes()
    zeroed = content[:4096] + bytes(len(content) - 4096)  # because its header is intact, it opens as an empty database
    file.write_bytes(zeroed)
    said = failure(path=file)
    assert (
        f"memory {file} is damaged, or is not a memory file (it has no tables)" in said
        and "Nothing was changed" in said
    )
    assert file.read_bytes() == zeroed


@pytest.mark.parametrize("damage", ["torn", "zeros", "rubbish"])
def test_a_damaged_log_is_read_up_to_the_damage_and_kept(
    tmp_path: Path, open_here: Open, caplog: pytest.LogCaptureFixture, damage: str
) -> None:
    path = tmp_path / "memory.lbug"
    log = Path(f"{path}.wal")
    memory = open_here(path=path)
    memory.create("Person", name="Ada").result()
    memory.close().result()
    memory = open_here(path=path)
    for name in ("Bob", "Cy"):
        memory.create("Person", name=name).result()
    before, content = path.read_bytes(), log.read_bytes()
    memory.close().result()
    path.write_bytes(before)  # as after a power failure, which closes nothing
    damaged = {"torn": content[:-9], "zeros": content + bytes(99), "rubbish": b"rubbish" * 99}[damage]
    expected = {"torn": ["Ada", "Bob"], "zeros": ["Ada", "Bob", "Cy"], "rubbish": ["Ada"]}[damage]
    for number in (1, 2):
        log.write_bytes(damaged)
        caplog.clear()
        memory = open_here(path=path)
        assert [node["name"] for node in memory.find("Person").result()][: len(expected)] == expected
        memory.close().result()
        copy = Path(f"{log}.damaged-{number}")
        assert copy.read_bytes() == damaged
        read = "nothing in it can be read" if damage == "rubbish" else "memory has read the part before the damage"
        assert f"memory {path} has a damaged log: {read}" in caplog.text and str(copy) in caplog.text
        if damage != "rubbish":
            break


def test_a_log_that_cannot_be_read_even_in_part_is_dropped_and_the_warning_says_so(
    file: Path, open_here: Open, caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    def survives(path: Path, *, whole_log: bool) -> bool:
        return whole_log and database.survives(path)

    monkeypatch.setattr(embedded, "survives", survives)
    log = Path(f"{file}.wal")
    log.write_bytes(b"rubbish" * 99)
    memory = open_here(path=file)
    assert [node["name"] for node in memory.find("Person").result()] == ["Ada"]
    assert f"memory {file} has a damaged log: nothing in it can be read" in caplog.text
    assert Path(f"{log}.damaged-1").read_bytes() == b"rubbish" * 99


def test_a_database_of_another_program_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "other.lbug"
    with (
        ladybug.Database(str(path), max_db_size=2**30) as database,
        ladybug.Connection(database) as connection,
    ):
        connection.execute("CREATE NODE TABLE Person(id STRING PRIMARY KEY)")
    assert "is a ladybug database of another program (it has Person)" in failure(path=path)


def test_a_path_that_is_a_folder_or_lies_below_a_file_is_refused(file: Path, tmp_path: Path) -> None:
    assert "cannot be opened" in failure(path=tmp_path)
    assert "cannot make its folder" in failure(path=file / "memory.lbug")


def test_a_stored_property_cannot_be_read_as_another_kind(file: Path, tmp_path: Path, open_here: Open) -> None:
    types = tmp_path / "mine.yaml"
    types.write_text("Person: {has: {shoe_size: text}}")
    memory = open_here(path=file, types=(types,))
    memory.update(memory.find("Person").result()[0], shoe_size="38 or so").result()
    memory.close().result()
    types.write_text("Person: {has: {shoe_size: number, hat_size: number}}")
    said = failure(path=file, types=(types,))
    assert "has Person.shoe_size as text, but the types say number: write shoe_size: text" in said
    types.write_text("Person: {has: {shoe_size: date}}")  # the store keeps a date as text, too
    memory = open_here(path=file, types=(types,))
    with pytest.raises(RuleError, match=r"memory has Person\.shoe_size = '38 or so', which is not a valid date"):
        memory.find("Person").result()


def test_a_forgotten_person_leaves_no_byte_in_any_file(tmp_path: Path, open_here: Open) -> None:
    path = tmp_path / "memory.lbug"
    types = tmp_path / "mine.yaml"
    types.write_text(
        "Boat: {is: Thing, has: {length: number}}\n"
        "Person: {has: {shoe_size: number}, relations: {owns: {to: Boat, has: {since: date}}}}"
    )
    memory = open_here(path=path, types=(types,))
    bob = memory.create("Person", name="Bob O'x 😀", born=date(2000, 2, 29), shoe_size=44.5).result()
    boat = memory.create("Boat", name="Lady").result()
    memory.relate(bob, "owns", boat, since=date(2020, 1, 1)).result()
    memory.relate(bob, "likes", bob).result()
    expected = memory.export().result()
    ada = memory.create("Person", name="Ada Augusta Lovelace", nickname="Countess of the Engines").result()
    memory.relate(ada, "lives_in", memory.create("City", name="Ockham in Surrey").result()).result()
    memory.close().result()

    memory = open_here(path=path)  # without the file of types, its nodes stay in memory
    assert [node["name"] for node in memory.forget(ada).result()] == [ada["name"], "Ockham in Surrey"]
    for file in tmp_path.iterdir():
        content = file.read_bytes()
        assert not any(trace in content for trace in (b"Ada Aug", b"Countess", b"Ockham", ada.id.encode()))
    memory.create("Person", name="Eve").result()
    memory.close().result()
    assert sorted(file.name for file in tmp_path.iterdir()) == ["memory.lbug", "memory.lbug.sum", "mine.yaml"]

    memory = open_here(path=path, types=(types,))
    [eve] = memory.find("Person", name="Eve").result()
    memory.together(lambda graph: graph.forget(eve)).result()
    assert not any(eve.id.encode() in file.read_bytes() for file in tmp_path.iterdir())
    assert memory.export().result() == expected


def test_a_failed_rewrite_still_forgets(
    tmp_path: Path, open_here: Open, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    def fail(*_: Any) -> None:
        raise OSError("no more space")

    memory = open_here(path=tmp_path / "memory.lbug")
    ada = memory.create("Person", name="Ada").result()
    bob = memory.create("Person", name="Bob").result()
    monkeypatch.setattr(embedded, "copy_database", fail)
    assert memory.forget(ada).result() == [ada]
    assert "the file still has their bytes: no more space" in caplog.text
    assert memory.find("Person").result() == [bob]
    monkeypatch.undo()
    memory.update(bob, age=3).result()
    assert not (tmp_path / "memory.lbug.new").exists()


def test_only_the_user_may_read_the_file(tmp_path: Path, open_here: Open) -> None:
    path = tmp_path / "new" / "folder" / "memory.lbug"
    open_here(path=path)
    assert stat.S_IMODE(path.stat().st_mode) == 0o600
    assert stat.S_IMODE(path.parent.stat().st_mode) == 0o700


def test_the_error_names_a_missing_package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "ladybug", None)
    assert failure(path=tmp_path / "x") == "ontology needs ladybug: pip install 'ravestate[ontology]'"
    assert list(tmp_path.iterdir()) == []


def test_tidy_moves_the_log_into_the_file(tmp_path: Path, open_here: Open) -> None:
    memory = open_here(path=tmp_path / "memory.lbug")
    memory.create("Person", name="Ada").result()
    log = tmp_path / "memory.lbug.wal"
    assert log.stat().st_size > 0
    memory.tidy().result()
    assert not log.exists() or log.stat().st_size == 0
