"""Bring an index up to date with files and folders: read new and changed files, and forget deleted files."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal

from .document import Document
from .index import Index, IndexedFile
from .reading import Unreadable, kind_of, read

Reading = Callable[[Path, int], object]
"""A callback for each document. Its arguments are the file, and the number of documents before it in the file."""

Kind = Literal["added", "replaced", "unchanged", "removed", "unreadable"]


@dataclass(frozen=True, slots=True)
class Outcome:
    """The result for one file."""

    path: Path
    kind: Kind
    passages: int = 0
    why: str = ""
    """The reason why the file is unreadable; empty if it is readable."""


@dataclass(slots=True)
class Found:
    """The files under some paths, before they are read."""

    files: list[tuple[Path, str]] = field(default_factory=list[tuple[Path, str]])
    """The files, each with its source. An answer names this source."""
    roots: list[Path] = field(default_factory=list[Path])
    """The paths that are folders. The index may still have files that have been deleted from these folders."""
    unreadable: list[Outcome] = field(default_factory=list[Outcome])


def find(paths: Iterable[Path], index: Index) -> Found:
    """Return the files under `paths`: single files, and the files of known kinds in folders.

    Inside a folder, hidden files, hidden folders and links to folders are skipped.
    """
    found = Found()
    for path in paths:
        root = Path(os.path.abspath(path.expanduser()))
        if root.is_dir():
            found.roots.append(root)
            _walk(root, found)
        elif root.exists():
            found.files.append((root, root.name))
        else:
            known = any(within(file.path, root) for file in index.files())
            hint = f"; to forget what was read from it: ravestate genqa forget {path}" if known else ""
            found.unreadable.append(Outcome(root, "unreadable", why=f"it does not exist{hint}"))
    found.files = list({name_of(path): (path, source) for path, source in found.files}.values())
    return found


def collect(found: Found, index: Index, reading: Reading | None = None) -> Iterator[Outcome]:
    """Bring `index` up to date, file by file; each file is added completely, or not at all.

    Args:
        found: The files.
        index: The index.
        reading: A callback for each document; a file may hold millions of them.

    Yields:
        The result for each file, in order; unreadable paths come first, and deleted files last.

    Raises:
        PlatformError: The disk is full, or another process has been writing for too long.
    """
    yield from found.unreadable
    seen: set[str] = set()
    for path, source in found.files:
        seen.add(name_of(path))
        yield _take_in(path, source, index, reading)
    blocked = [outcome.path for outcome in found.unreadable]
    for known in list(index.files()):
        gone = any(within(known.path, root) for root in found.roots) and known.path not in seen
        if gone and not any(within(known.path, folder) for folder in blocked):
            index.forget(known.path)
            yield Outcome(Path(known.path), "removed", known.passages)


def name_of(path: Path) -> str:
    r"""Return the path's name in the index. Bytes that are not UTF-8 become escapes such as ``\xff``."""
    return os.fsencode(path).decode("utf-8", "backslashreplace")


def within(name: str, root: Path) -> bool:
    """Return whether the file of this name is `root`, or is inside it."""
    above = name_of(root)
    return name == above or name.startswith(above.rstrip(os.sep) + os.sep)


# -------------------------------------------------------------------------------------- internals


def _walk(root: Path, found: Found) -> None:
    def complain(error: OSError) -> None:
        found.unreadable.append(Outcome(Path(error.filename or root), "unreadable", why=error.strerror or str(error)))

    for folder, folders, names in os.walk(root, onerror=complain):
        folders[:] = sorted(name for name in folders if not name.startswith("."))
        for name in sorted(names):
            file = Path(folder, name)
            if not name.startswith(".") and kind_of(file) is not None:
                found.files.append((file, name_of(file.relative_to(root.parent))))


def _take_in(path: Path, source: str, index: Index, reading: Reading | None) -> Outcome:
    name = name_of(path)
    try:
        state = path.stat()
        known = index.file(name)
        if known is not None and (known.size, known.modified) == (state.st_size, state.st_mtime_ns):
            return Outcome(path, "unchanged", known.passages)
        now = IndexedFile(name, state.st_size, state.st_mtime_ns, _digest(path))
        if known is not None and known.digest == now.digest:
            index.touch(now)
            return Outcome(path, "unchanged", known.passages)
        passages = index.put(now, _watched(path, read(path, source), reading))
    except Unreadable as error:
        return Outcome(path, "unreadable", why=str(error))
    except OSError as error:
        return Outcome(path, "unreadable", why=error.strerror or str(error))
    return Outcome(path, "added" if known is None else "replaced", passages)


def _watched(path: Path, documents: Iterator[Document], reading: Reading | None) -> Iterator[Document]:
    for number, document in enumerate(documents):
        if reading is not None:
            reading(path, number)
        yield document


def _digest(path: Path) -> str:
    with path.open("rb") as content:
        return hashlib.file_digest(content, lambda: hashlib.blake2b(digest_size=16)).hexdigest()
