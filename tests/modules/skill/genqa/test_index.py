"""The index finds passages by their words, replaces whole files, and reports what is wrong."""

import shutil
import sqlite3
from collections.abc import Iterator
from pathlib import Path

import pytest

import ravestate as rs
from ravestate.modules.skill.genqa.document import Document, Passage
from ravestate.modules.skill.genqa.index import FORMAT, Index, IndexedFile


def file(name: str = "/notes.txt", digest: str = "1") -> IndexedFile:
    return IndexedFile(name, 10, 1, digest)


def notes(*texts: str, title: str = "Notes", source: str = "notes.txt") -> list[Document]:
    return [Document(title, source, [Passage(text) for text in texts])]


def found(index: Index, *words: str) -> list[str]:
    return [each.text for each in index.search(words, 10)]


def test_passages_with_more_and_rarer_words_come_first(index: Index) -> None:
    index.put(file(), notes("The tram is red.", "The bus is red.", "The tram is yellow, and goes to the beach."))
    assert found(index, "tram", "beach")[0] == "The tram is yellow, and goes to the beach."
    assert found(index, "submarine") == []


def test_search_all_finds_passages_with_a_word_of_each_group(index: Index) -> None:
    index.put(file(), notes("The tram is red.", "The bus is red.", "The bus is blue."))
    assert {each.text for each in index.search_all([["tram", "bus"], ["red"]], 9)} == {
        "The tram is red.",
        "The bus is red.",
    }
    assert index.search_all([["ship"], ["red"]], 9) == index.search_all([], 9) == index.search_all([['"'], []], 9) == []


def test_titles_and_hints_are_searched_by_their_stems(index: Index) -> None:
    index.put(file(), [Document("Trams", "t", [Passage("Number 7 goes there.", hints="beaches")])])
    assert found(index, "tram") == found(index, "beach") == ["Number 7 goes there."]


@pytest.mark.parametrize(
    ("title", "name"),
    [
        ("Notes", "notes"),
        ("The Tram", "tram"),
        ("Österreich", "Österreich"),
        ("Österreich", "österreich"),
        ("österreich", "ÖSTERREICH"),
        ("The Élysée Palace", "the élysée palace"),
        ("Élysée Palace", "The ÉLYSÉE PALACE"),
        ("Санкт-Петербург", "санкт-петербург"),
    ],
)
def test_the_case_of_a_title_does_not_matter(index: Index, title: str, name: str) -> None:
    index.put(file(), [*notes("It is red.", title=title), *notes("It is blue.", title="Other")])
    assert index.title_of(name) == title
    assert index.title_of(name[1:]) == ""


@pytest.mark.parametrize(
    "words", [('"',), ("a OR b",), ("NEAR(",), ("*",), ("title:x",), ("\0",), ("",), ("é" * 9999,)]
)
def test_no_word_of_a_query_acts_as_a_search_operator(index: Index, words: tuple[str, ...]) -> None:
    index.put(file(), notes("The tram is red."))
    assert found(index, *words) == []


def test_a_file_in_the_index_is_replaced_completely(index: Index) -> None:
    index.put(file(), notes("The tram is red.", "The bus is red."))
    index.put(file("/other.txt"), notes("The ship is grey.", source="other.txt"))
    index.put(file(digest="2"), notes("The tram is blue."))
    assert found(index, "tram", "bus", "ship") == ["The ship is grey.", "The tram is blue."] or found(
        index, "tram", "bus", "ship"
    ) == ["The tram is blue.", "The ship is grey."]
    assert index.size() == 2
    known = index.file("/notes.txt")
    assert known is not None
    assert (known.digest, known.passages) == ("2", 1)


def test_each_passage_has_its_source(index: Index) -> None:
    index.put(file("/a"), [*notes("The tram is red.", source="a, page 1"), *notes(source="a, page 2")])
    index.put(file("/b"), notes("The ship is grey.", source="b"))
    index.put(
        file("/a"),
        [*notes("The kite is red.", source="a, page 1"), *notes("The owl is wise.", source="a, page 2")],
    )
    sources = {each.text: index.source(each.row) for each in index.search(["kite", "owl", "ship"], 9)}
    assert sources == {
        "The kite is red.": "a, page 1",
        "The owl is wise.": "a, page 2",
        "The ship is grey.": "b",
    }


def test_a_forgotten_file_leaves_nothing_in_the_index(index: Index) -> None:
    index.put(file(), notes("The tram is red."))
    assert index.forget("/notes.txt")
    assert not index.forget("/notes.txt")
    assert found(index, "tram") == []
    assert (index.size(), list(index.files()), index.frequencies(["tram"])) == (0, [], {})


def test_frequencies_are_counted_for_stems(index: Index) -> None:
    index.put(file(), notes("Trams go there.", "A tram is red.", "A bus is blue."))
    assert index.frequencies(["tram", "bu", "ship"]) == {"tram": 2, "bu": 1}


def test_a_failure_while_reading_a_file_does_not_change_the_index(index: Index) -> None:
    index.put(file(), notes("The tram is red."))

    def broken() -> Iterator[Document]:
        yield from notes("The tram is blue.")
        raise ValueError("damaged")

    with pytest.raises(ValueError, match="damaged"):
        index.put(file(digest="2"), broken())
    assert found(index, "tram") == ["The tram is red."]
    index.put(file(digest="3"), notes("The tram is green."))  # the index can still be written
    assert found(index, "tram") == ["The tram is green."]


def test_an_index_keeps_its_passages_when_it_is_opened_again(tmp_path: Path) -> None:
    with Index(tmp_path / "deep" / "er" / "index.sqlite") as index:
        index.put(file(), notes("The tram is red."))
    with Index(tmp_path / "deep" / "er" / "index.sqlite") as index:
        assert found(index, "tram") == ["The tram is red."]


def test_a_process_can_read_while_another_writes(index: Index) -> None:
    index.put(file(), notes("The tram is red."))

    def slow() -> Iterator[Document]:
        with Index(index.path) as reader:
            assert found(reader, "tram") == ["The tram is red."]
        yield from notes("The tram is blue.")

    index.put(file(digest="2"), slow())
    assert found(index, "tram") == ["The tram is blue."]


# ------------------------------------------------------------------------------------------- errors


def test_a_full_disk_is_reported_and_no_passage_is_lost(index: Index, connections: list[sqlite3.Connection]) -> None:
    index.put(file(), notes("The tram is red."))
    [base] = connections
    base.execute(f"PRAGMA max_page_count = {base.execute('PRAGMA page_count').fetchone()[0] + 4}")
    with pytest.raises(rs.PlatformError, match="the disk is full: make room"):
        index.put(file("/big.txt"), notes(*(f"Passage {n} is about rain." for n in range(5000))))
    assert found(index, "tram") == ["The tram is red."]
    assert [known.path for known in index.files()] == ["/notes.txt"]


def test_an_index_of_a_newer_version_is_refused_and_not_changed(tmp_path: Path) -> None:
    path = tmp_path / "index.sqlite"
    Index(path).close()
    base = sqlite3.connect(path)
    base.execute(f"PRAGMA user_version = {FORMAT + 1}")
    base.close()
    before = path.read_bytes()
    with pytest.raises(rs.PlatformError, match=rf"newer Ravestate \(format {FORMAT + 1}, this one knows {FORMAT}\)"):
        Index(path)
    assert path.read_bytes() == before


def test_a_database_of_another_program_cannot_become_an_index(tmp_path: Path) -> None:
    base = sqlite3.connect(tmp_path / "photos.sqlite")
    base.execute("CREATE TABLE photos (name TEXT)")
    base.close()
    with pytest.raises(rs.PlatformError, match="not an index of genqa"):
        Index(tmp_path / "photos.sqlite")


@pytest.mark.parametrize("content", [b"Dear diary, " * 100, b"SQLite format 3\0" + b"\xff" * 4096])
def test_a_file_that_is_not_an_index_is_refused(tmp_path: Path, content: bytes) -> None:
    (tmp_path / "index.sqlite").write_bytes(content)
    with pytest.raises(rs.PlatformError, match="it is not an index, or damaged"):
        Index(tmp_path / "index.sqlite")
    assert (tmp_path / "index.sqlite").read_bytes() == content


def test_a_path_where_no_file_can_be_made_is_reported(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    with pytest.raises(rs.PlatformError, match="genqa: the index"):
        Index(tmp_path / "file" / "index.sqlite")
    with pytest.raises(rs.PlatformError, match="genqa: the index"):
        Index(tmp_path)


def test_an_index_that_cannot_be_written_is_reported(index: Index, connections: list[sqlite3.Connection]) -> None:
    index.put(file(), notes("The tram is red."))
    connections[0].execute("PRAGMA query_only = ON")
    with pytest.raises(rs.PlatformError, match="cannot be written: name another file"):
        index.put(file(digest="2"), notes("The tram is blue."))
    assert found(index, "tram") == ["The tram is red."]


def test_a_writer_that_waits_too_long_for_another_writer_raises_an_error(index: Index) -> None:
    def meanwhile() -> Iterator[Document]:
        with (
            Index(index.path, timeout=0.0) as other,
            pytest.raises(rs.PlatformError, match="another process is writing"),
        ):
            other.put(file("/other.txt"), notes("The ship is grey."))
        yield from notes("The tram is red.")

    index.put(file(), meanwhile())
    assert found(index, "tram", "ship") == ["The tram is red."]


def test_an_index_notices_that_its_file_has_been_replaced(index: Index, tmp_path: Path) -> None:
    assert index.in_place()
    shutil.copy(index.path, tmp_path / "copy")
    index.path.unlink()
    assert not index.in_place()
    (tmp_path / "copy").rename(index.path)
    assert not index.in_place()
