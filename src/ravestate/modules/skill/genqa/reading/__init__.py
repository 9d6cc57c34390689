"""Files of all kinds, read into documents: one file of code for each kind."""

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
"""How a file's name ends, and what reads it."""


def kind_of(path: Path) -> str | None:
    """What reads this file; None if nothing does."""
    return KINDS.get(path.suffix.lower())


def read(path: Path, source: str) -> Iterator[Document]:
    """Yield the documents of a file; it is read while you take them.

    Args:
        path: The file; its ending says what it is.
        source: Where answers will say that they are from.

    Raises:
        Unreadable: It cannot be read, is not what its ending says, or what reads it is not installed: the message says
            why, without the file's name.
    """
    kind = kind_of(path)
    if kind is None:
        raise Unreadable(
            f"nothing reads files that end in {path.suffix!r}: it must be one of {', '.join(KINDS)}"
        )
    reader: Callable[[Path, str], Iterator[Document]] = import_module(f"{__name__}.{kind}").read
    try:
        yield from reader(path, source)
    except Unreadable:
        raise
    except OSError as error:
        raise Unreadable(error.strerror or str(error)) from error
    except RecursionError as error:
        raise Unreadable("it is nested too deeply") from error
