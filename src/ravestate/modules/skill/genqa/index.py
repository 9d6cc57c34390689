"""The index: one SQLite file with passages, their sources, and their words."""

from __future__ import annotations

import sqlite3
import threading
from collections.abc import Generator, Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ravestate.errors import PlatformError
from ravestate.modules._text import printable

from .document import Document
from .stems import TOKENIZER

FORMAT = 1
"""The version of the file format. A file of a greater version is refused."""
APPLICATION = 0x52764741
"""The number in an SQLite file that marks it as an index of genqa."""

_SCHEMA = f"""
CREATE TABLE files (
    path TEXT PRIMARY KEY, size INTEGER NOT NULL, modified INTEGER NOT NULL, digest TEXT NOT NULL,
    passages INTEGER NOT NULL
) WITHOUT ROWID;
CREATE TABLE documents (
    first INTEGER PRIMARY KEY, last INTEGER NOT NULL, path TEXT NOT NULL, title TEXT NOT NULL, source TEXT NOT NULL
);
CREATE INDEX documents_of_title ON documents (title COLLATE NOCASE);
CREATE INDEX documents_of_file ON documents (path);
CREATE VIRTUAL TABLE passages USING fts5(title, text, hints, tokenize='{TOKENIZER}');
CREATE VIRTUAL TABLE words USING fts5vocab(passages, 'row');
PRAGMA application_id = {APPLICATION};
PRAGMA user_version = {FORMAT};
"""
# The ranking, with the weights of matches in the title, the text and the hints (further words for the search).
_RANK = "bm25(passages, 1.0, 1.0, 0.7)"


@dataclass(frozen=True, slots=True)
class IndexedFile:
    """The state of a file at the time when it was read."""

    path: str
    size: int
    """The size in bytes."""
    modified: int
    """The time of the last change in nanoseconds, from the file system."""
    digest: str
    """A hash of the file's content."""
    passages: int = 0


@dataclass(frozen=True, slots=True)
class Found:
    """A passage in the index."""

    row: int
    title: str
    text: str
    hints: str


class Index:
    """Passages on disk. Any number of processes may read while one process writes; threads of one `Index` take turns.

    Each file is added, replaced or removed as a whole, in one transaction. If Ctrl-C, ``kill -9`` or a full disk
    interrupts the transaction, the index stays as it was before.

    Example:
        ::

            with Index(Path("my.sqlite")) as index:
                index.put(IndexedFile("notes.txt", 11, 0, "…"), [Document("Notes", "notes.txt", [Passage("It rains.")])])
                index.search(["rain"], 5)
    """

    def __init__(self, path: Path, *, timeout: float = 30.0) -> None:
        """Open the file, or create it.

        Args:
            path: The file. A missing file or folder is created.
            timeout: Seconds to wait for another process that writes.

        Raises:
            PlatformError: The file cannot be opened, has a newer version, or is not an index.
        """
        self.path = path
        self._lock = threading.RLock()
        with self._told():
            path.parent.mkdir(parents=True, exist_ok=True)
            self._base = sqlite3.connect(path, timeout=timeout, check_same_thread=False, isolation_level=None)
        try:
            with self._told():
                self._prepare()
                seen = path.stat()
                self._inode = (seen.st_dev, seen.st_ino)
        except BaseException:
            self._base.close()
            raise

    def __enter__(self) -> Index:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Close the file."""
        with self._lock:
            self._base.close()

    def in_place(self) -> bool:
        """Return whether the path still leads to the open file."""
        try:
            seen = self.path.stat()
        except OSError:
            return False
        return (seen.st_dev, seen.st_ino) == self._inode

    # ------------------------------------------------------------------------------- what is in it

    def files(self) -> Iterator[IndexedFile]:
        """Yield all files that have been read, in the order of their paths."""
        return (IndexedFile(*row) for row in self._rows("SELECT * FROM files ORDER BY path"))

    def file(self, path: str) -> IndexedFile | None:
        """Return the file with this path; None if it was not read."""
        rows = self._rows("SELECT * FROM files WHERE path = ?", path)
        return IndexedFile(*rows[0]) if rows else None

    def size(self) -> int:
        """Return the number of passages."""
        return self._rows("SELECT coalesce(sum(passages), 0) FROM files")[0][0]

    def source(self, row: int) -> str:
        """Return the source of the passage in a row of the index."""
        found = self._rows("SELECT source FROM documents WHERE first <= ? ORDER BY first DESC LIMIT 1", row)
        return found[0][0] if found else ""

    def title_of(self, name: str) -> str:
        """Return the title that equals `name`, or "". Ignore case, and *the* at the beginning."""
        bare = name.lower().removeprefix("the ")
        same = "title COLLATE NOCASE"
        if not bare.isascii():  # SQLite ignores the case of ASCII letters only
            same = "title GLOB '*[^ -~]*' AND lower_case(title)"
        found = self._rows(f"SELECT title FROM documents WHERE {same} IN (?, ?) LIMIT 1", bare, f"the {bare}")
        return found[0][0] if found else ""

    def frequencies(self, stems: Sequence[str]) -> dict[str, int]:
        """Return the number of passages with each stem; leave out stems without passages."""
        marks = ", ".join("?" * len(stems))
        return dict(self._rows(f"SELECT term, doc FROM words WHERE term IN ({marks})", *stems))

    # ---------------------------------------------------------------------------------- searching

    def passages(self, title: str, limit: int) -> list[Found]:
        """Return the first `limit` passages of the documents with this title."""
        query = """
            SELECT p.rowid, p.title, text, hints FROM documents d JOIN passages p ON p.rowid BETWEEN d.first AND d.last
            WHERE d.title = ? COLLATE NOCASE LIMIT ?"""
        return [Found(*row) for row in self._rows(query, title, limit)]

    def search(self, words: Sequence[str], limit: int, *, without: Sequence[str] = ()) -> list[Found]:
        """Return the passages that match `words` best, ranked by BM25, best first.

        Args:
            words: Any text; operators of the query language are plain words here.
            limit: The maximum number of passages.
            without: Words that exclude a passage.
        """
        return self.search_all([words], limit, without=without)

    def search_all(self, groups: Sequence[Sequence[str]], limit: int, *, without: Sequence[str] = ()) -> list[Found]:
        """Return passages as `search` does, but only passages with a word of each group."""
        query = " AND ".join(f"({any_of})" for group in groups if (any_of := _any_of(group)))
        if not query:
            return []
        if without:
            query = f"({query}) NOT ({_any_of(without)})"
        matching = f"SELECT rowid, title, text, hints FROM passages WHERE passages MATCH ? ORDER BY {_RANK} LIMIT ?"
        return [Found(*row) for row in self._rows(matching, query, limit)]

    # ------------------------------------------------------------------------------------ writing

    def put(self, file: IndexedFile, documents: Iterable[Document]) -> int:
        """Add a file, or replace it; return the number of its passages.

        Raises:
            PlatformError: The disk is full, or another process has been writing for too long. After this error, and after
                an error in reading `documents`, the index is unchanged.
        """
        with self._changing():
            self._forget(file.path)
            row = first = self._base.execute("SELECT coalesce(max(rowid), 0) + 1 FROM passages").fetchone()[0]
            for document in documents:
                start, title, source = row, printable(document.title), printable(document.source)
                for passage in document.passages:
                    self._base.execute(
                        "INSERT INTO passages (rowid, title, text, hints) VALUES (?, ?, ?, ?)",
                        (row, title, passage.text, passage.hints),
                    )
                    row += 1
                if row > start:
                    self._base.execute(
                        "INSERT INTO documents (first, last, path, title, source) VALUES (?, ?, ?, ?, ?)",
                        (start, row - 1, file.path, title, source),
                    )
            self._base.execute(
                "INSERT INTO files (path, size, modified, digest, passages) VALUES (?, ?, ?, ?, ?)",
                (file.path, file.size, file.modified, file.digest, row - first),
            )
        return row - first

    def touch(self, file: IndexedFile) -> None:
        """Save the new size and the new time of change of a file whose content is the same as before."""
        with self._changing():
            self._base.execute(
                "UPDATE files SET size = ?, modified = ? WHERE path = ?",
                (file.size, file.modified, file.path),
            )

    def forget(self, path: str) -> bool:
        """Remove a file with its passages; return whether it was there."""
        with self._changing():
            return self._forget(path)

    # ---------------------------------------------------------------------------------- internals

    def _rows(self, query: str, *values: str | int) -> list[Any]:
        with self._lock, self._told():
            return self._base.execute(query, values).fetchall()

    def _forget(self, path: str) -> bool:
        ranges = self._base.execute("SELECT first, last FROM documents WHERE path = ?", (path,)).fetchall()
        self._base.executemany("DELETE FROM passages WHERE rowid BETWEEN ? AND ?", ranges)
        self._base.execute("DELETE FROM documents WHERE path = ?", (path,))
        return self._base.execute("DELETE FROM files WHERE path = ?", (path,)).rowcount > 0

    def _prepare(self) -> None:
        version = self._base.execute("PRAGMA user_version").fetchone()[0]
        ours = self._base.execute("PRAGMA application_id").fetchone()[0]
        empty = not self._base.execute("SELECT count(*) FROM sqlite_master").fetchone()[0]
        if not empty and ours != APPLICATION:
            raise PlatformError(f"genqa: {self.path} is an SQLite file, but not an index of genqa: {_OTHER}")
        if version > FORMAT:
            raise PlatformError(
                f"genqa: the index {self.path} was written by a newer Ravestate (format {version}, this one knows "
                f"{FORMAT}): update Ravestate, or {_OTHER}"
            )
        self._base.create_function("lower_case", 1, str.lower, deterministic=True)
        self._base.execute("PRAGMA journal_mode = WAL")  # readers and a writer do not wait for each other
        self._base.execute("PRAGMA synchronous = NORMAL")
        if empty:
            with self._changing():
                # Another process may have made the tables meanwhile.
                if not self._base.execute("SELECT count(*) FROM sqlite_master").fetchone()[0]:
                    for statement in _SCHEMA.split(";\n"):
                        self._base.execute(statement)

    @contextmanager
    def _changing(self) -> Generator[None]:
        with self._lock, self._told():
            self._base.execute("BEGIN IMMEDIATE")
            try:
                yield
                self._base.execute("COMMIT")
            except BaseException:
                if self._base.in_transaction:  # SQLite may have rolled back by itself
                    self._base.execute("ROLLBACK")
                raise

    @contextmanager
    def _told(self) -> Generator[None]:
        """Turn an error of SQLite into a `PlatformError` in plain words."""
        try:
            yield
        except sqlite3.Error as error:
            code = getattr(error, "sqlite_errorname", "") or ""
            why = next((why for start, why in _ERRORS.items() if code.startswith(f"SQLITE_{start}")), str(error))
            raise PlatformError(f"genqa: the index {self.path}: {why}") from error
        except OSError as error:
            raise PlatformError(f"genqa: the index {self.path}: {error.strerror or error}") from error


_OTHER = "name another file: --set genqa.index=/path/to/index.sqlite"
_BUSY = "another process is writing to it: wait until `ravestate genqa index` has ended there"
_DAMAGED = f"it is not an index, or damaged: remove it and read the files again, or {_OTHER}"
_ERRORS = {
    "FULL": "the disk is full: make room, then try again; the index keeps the files that were read completely",
    "BUSY": _BUSY, "LOCKED": _BUSY, "NOTADB": _DAMAGED, "CORRUPT": _DAMAGED,
    "READONLY": f"it cannot be written: {_OTHER}", "CANTOPEN": f"it cannot be opened: {_OTHER}",
}  # fmt: skip
"""Beginning of an SQLite error's name, without ``SQLITE_`` → the problem and the advice."""


def _any_of(words: Sequence[str]) -> str:
    """Return a query for any of these words; operators in them count as plain words."""
    terms = [clean for word in words if (clean := word.replace('"', " ").replace("\0", " ").strip())]
    return " OR ".join(f'"{term}"' for term in terms)
