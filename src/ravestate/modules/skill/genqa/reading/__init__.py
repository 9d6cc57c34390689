"""Readers for all kinds of files, each in its own file."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from importlib import import_module
from pathlib import Path

from ..document import Document
from .unreadable import Unreadable

__all__ = ["KINDS", "Unreadable", "kind_of", "read"]

KINDS = {
    ".txt": "text",
    ".text": "text",
    ".md": "markdown",
    ".markdown": "markdown",
    ".html": "html",
    ".htm": "html",
    ".xhtml": "html",
    ".pdf": "pdf",
    ".jsonl": "jsonl",
    ".ndjson": "jsonl",
    ".zim": "zim",
}
"""The reader for each ending of a file's name."""


def kind_of(path: Path) -> str | None:
    """Return the reader's name for a file; None if there is none."""
    return KINDS.get(path.suffix.lower())


def read(path: Path, source: str) -> Iterator[Document]:
    """Yield the documents of a file, while it is read.

    Args:
        path: The file; its ending names its kind.
        source: The source that answers name.

    Raises:
        Unreadable: The file cannot be read, is of another kind than its ending, or a library is missing. The message says
            why, without the file's name.
    """
    kind = kind_of(path)
    if kind is None:
        raise Unreadable(f"nothing reads files that end in {path.suffix!r}: it must be one of {', '.join(KINDS)}")
    reader: Callable[[Path, str], Iterator[Document]] = import_module(f"{__name__}.{kind}").read
    try:
        yield from reader(path, source)
    except Unreadable:
        raise
    except OSError as error:
        raise Unreadable(error.strerror or str(error)) from error
    except RecursionError as error:
        raise Unreadable("it is nested too deeply") from error
