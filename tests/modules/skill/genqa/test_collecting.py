"""Only new and changed files are indexed, one after another."""

import hashlib
import os
import signal
import sqlite3
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

import ravestate as rs
from ravestate.modules.skill.genqa import collecting
from ravestate.modules.skill.genqa.collecting import collect, find
from ravestate.modules.skill.genqa.document import Document, Passage
from ravestate.modules.skill.genqa.index import Index


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder with a few documents."""
    docs = tmp_path / "docs"
    (docs / "deep").mkdir(parents=True)
    (docs / "tram.txt").write_text("The tram is red.", encoding="utf-8")
    (docs / "deep" / "ship.md").write_text("# Ships\n\nThe ship is grey.", encoding="utf-8")
    (docs / "photo.jpg").write_bytes(b"\xff\xd8")
    (docs / ".hidden.txt").write_text("Nobody reads this file.", encoding="utf-8")
    return docs


def take_in(index: Index, *paths: Path) -> dict[str, str]:
    """Index these paths. Return the result for each file, by its name."""
    return {outcome.path.name: outcome.kind for outcome in collect(find(paths, index), index)}


def said(index: Index, *words: str) -> set[str]:
    return {found.text for found in index.search(words, 20)}


def test_all_readable_files_of_a_folder_and_its_subfolders_are_indexed(index: Index, folder: Path) -> None:
    assert take_in(index, folder) == {"tram.txt": "added", "ship.md": "added"}
    assert said(index, "tram", "ship", "nobody") == {"The tram is red.", "The ship is grey."}
    rows = {found.text: index.source(found.row) for found in index.search(["tram", "ship"], 9)}
    assert rows == {"The tram is red.": "docs/tram.txt", "The ship is grey.": "docs/deep/ship.md"}


def test_the_callback_sees_each_document_of_a_large_file(index: Index, folder: Path) -> None:
    (folder / "many.jsonl").write_text('{"text": "The ferry is white."}\n' * 3, encoding="utf-8")
    told: list[tuple[str, int]] = []
    many = find([folder / "many.jsonl"], index)
    [outcome] = collect(many, index, lambda path, number: told.append((path.name, number)))
    assert outcome.passages == 3
    assert told == [("many.jsonl", 0), ("many.jsonl", 1), ("many.jsonl", 2)]


def test_unchanged_files_are_not_read_again(index: Index, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    take_in(index, folder)
    monkeypatch.setattr(collecting, "read", lambda path, source: pytest.fail(f"{path} was read"))
    assert take_in(index, folder) == {"tram.txt": "unchanged", "ship.md": "unchanged"}
    os.utime(folder / "tram.txt", ns=(1, 1))  # another date, but the same content
    assert take_in(index, folder)["tram.txt"] == "unchanged"
    monkeypatch.setattr(hashlib, "file_digest", lambda file, _: pytest.fail(f"{file} was opened"))
    assert take_in(index, folder)["tram.txt"] == "unchanged", "the index must keep the new date"


def test_changed_files_are_replaced(index: Index, folder: Path) -> None:
    take_in(index, folder)
    (folder / "tram.txt").write_text("The tram is yellow now.", encoding="utf-8")
    assert take_in(index, folder) == {"tram.txt": "replaced", "ship.md": "unchanged"}
    assert said(index, "tram") == {"The tram is yellow now."}


def test_deleted_files_are_removed_from_the_index(index: Index, folder: Path) -> None:
    take_in(index, folder)
    (folder / "tram.txt").unlink()
    assert take_in(index, folder) == {"ship.md": "unchanged", "tram.txt": "removed"}
    assert said(index, "tram") == set()


def test_indexing_a_folder_does_not_affect_other_folders(index: Index, folder: Path, tmp_path: Path) -> None:
    take_in(index, folder)
    (tmp_path / "docs2").mkdir()
    (tmp_path / "docs2" / "bus.txt").write_text("The bus is blue.", encoding="utf-8")
    assert take_in(index, tmp_path / "docs2") == {"bus.txt": "added"}
    assert index.size() == 3


def test_a_missing_folder_does_not_remove_its_files_from_the_index(index: Index, folder: Path) -> None:
    """For example, a disk that is not mounted must not empty the index."""
    take_in(index, folder)
    folder.rename(folder.with_name("moved"))
    (outcome,) = collect(find([folder], index), index)
    assert outcome.kind == "unreadable"
    assert outcome.why == f"it does not exist; to forget what was read from it: ravestate genqa forget {folder}"
    assert index.size() == 2


def test_unreadable_files_are_reported_and_the_other_files_are_indexed(index: Index, folder: Path) -> None:
    (folder / "a.txt").write_bytes(b"\xff\xfe\xfa")
    (folder / "b.pdf").write_bytes(b"%PDF-")
    (folder / "c.jsonl").write_text("{", encoding="utf-8")
    (folder / "d.txt").symlink_to(folder / "nowhere")
    assert take_in(index, folder) == {
        "a.txt": "unreadable",
        "b.pdf": "unreadable",
        "c.jsonl": "unreadable",
        "d.txt": "unreadable",
        "tram.txt": "added",
        "ship.md": "added",
    }


def test_a_file_that_becomes_unreadable_stays_in_the_index(index: Index, folder: Path) -> None:
    take_in(index, folder)
    (folder / "tram.txt").write_bytes(b"\xff broken")
    assert take_in(index, folder)["tram.txt"] == "unreadable"
    assert said(index, "tram") == {"The tram is red."}


def test_a_file_with_an_unknown_extension_is_reported_if_the_user_names_it(index: Index, folder: Path) -> None:
    (outcome,) = collect(find([folder / "photo.jpg"], index), index)
    assert outcome.kind == "unreadable"
    assert "'.jpg'" in outcome.why


def test_a_file_that_is_named_twice_is_read_once(index: Index, folder: Path) -> None:
    found = find([folder, folder / "tram.txt", folder / "deep" / ".." / "tram.txt"], index)
    assert len(found.files) == 2


def test_circular_links_do_not_cause_an_endless_search(index: Index, folder: Path) -> None:
    (folder / "deep" / "up").symlink_to(folder)
    assert set(take_in(index, folder)) == {"tram.txt", "ship.md"}


def test_a_file_whose_name_is_not_utf8_is_indexed(index: Index, folder: Path) -> None:
    name = os.fsdecode(b"caf\xe9.txt")
    (folder / name).write_text("The cafe is closed.", encoding="utf-8")
    assert take_in(index, folder)[name] == "added"
    assert take_in(index, folder)[name] == "unchanged"
    assert said(index, "cafe") == {"The cafe is closed."}


def test_an_interrupted_run_keeps_all_complete_files(
    index: Index, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def read(path: Path, source: str) -> Iterator[Document]:
        yield Document("x", source, [Passage("The tram is red.")])
        if path.name == "tram.txt":
            raise KeyboardInterrupt

    monkeypatch.setattr(collecting, "read", read)
    (folder / "a.txt").write_text("x", encoding="utf-8")
    with pytest.raises(KeyboardInterrupt):
        take_in(index, folder)
    assert [Path(file.path).name for file in index.files()] == ["a.txt"]
    monkeypatch.undo()
    assert take_in(index, folder) == {"a.txt": "unchanged", "tram.txt": "added", "ship.md": "added"}


def test_a_run_that_ends_on_a_full_disk_keeps_all_complete_files(
    index: Index, connections: list[sqlite3.Connection], folder: Path
) -> None:
    (folder / "zz.txt").write_text("\n\n".join(f"Passage {n} is of rain." for n in range(20_000)), encoding="utf-8")
    [base] = connections
    base.execute(f"PRAGMA max_page_count = {base.execute('PRAGMA page_count').fetchone()[0] + 40}")
    with pytest.raises(rs.PlatformError, match="disk is full"):
        take_in(index, folder)
    assert said(index, "tram") == {"The tram is red."}


KILLED = """
import sys
from pathlib import Path
from ravestate.modules.skill.genqa.collecting import collect, find
from ravestate.modules.skill.genqa.index import Index
index = Index(Path(sys.argv[1]))
for outcome in collect(find([Path(sys.argv[2])], index), index):
    print(outcome.path.name, flush=True)
"""


@pytest.mark.parametrize("told", [1, 7])
def test_a_run_continues_where_a_killed_run_stopped(tmp_path: Path, told: int) -> None:
    docs = tmp_path / "docs"
    docs.mkdir()
    for number in range(40):
        text = "\n\n".join(f"Passage {n} of file {number} is about rain." for n in range(300))
        (docs / f"{number:02}.txt").write_text(text, encoding="utf-8")
    path = tmp_path / "index.sqlite"
    with subprocess.Popen(
        [sys.executable, "-c", KILLED, str(path), str(docs)], stdout=subprocess.PIPE, text=True
    ) as process:
        assert process.stdout is not None
        complete = [process.stdout.readline().strip() for _ in range(told)]
        process.send_signal(signal.SIGKILL)
    with Index(path) as index:
        kept = {Path(file.path).name: file.passages for file in index.files()}
        assert set(complete) <= set(kept), "each reported file must be in the index"
        assert set(kept.values()) == {300}, "each file must be complete"
        assert index.size() == len(index.search(["rain"], 100_000))
        outcomes = take_in(index, docs)
        assert {name: outcomes[name] for name in kept} == dict.fromkeys(kept, "unchanged")
        assert index.size() == len(index.search(["rain"], 100_000)) == 12_000
