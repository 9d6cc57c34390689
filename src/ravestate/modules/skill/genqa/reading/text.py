"""A reader for plain text, and the decoding for other readers."""

from __future__ import annotations

import codecs
from collections.abc import Iterator
from pathlib import Path

from ..document import Document
from ..passages import passages_of
from .unreadable import Unreadable

LARGEST = 64 << 20
"""Bytes of a text file, which is held in memory."""

_MARKS = (
    (codecs.BOM_UTF8, "utf-8"),
    (codecs.BOM_UTF32_LE, "utf-32-le"),
    (codecs.BOM_UTF32_BE, "utf-32-be"),
    (codecs.BOM_UTF16_LE, "utf-16-le"),
    (codecs.BOM_UTF16_BE, "utf-16-be"),
)


def read(path: Path, source: str) -> Iterator[Document]:
    """Yield one document with the file's name as its title."""
    yield Document(path.stem.replace("_", " "), source, passages_of(decoded(path)))


def decoded(path: Path) -> str:
    """Return the text of a file: UTF-8, or the encoding of its byte order mark.

    Raises:
        Unreadable: It is in another encoding, binary, or huge.
    """
    if (size := path.stat().st_size) > LARGEST:
        raise Unreadable(f"it has {size >> 20} MB, and a text may have {LARGEST >> 20}: split it")
    content = path.read_bytes()
    mark, encoding = next(((m, e) for m, e in _MARKS if content.startswith(m)), (b"", "utf-8"))
    if not mark and b"\0" in content:
        raise Unreadable("it is binary, not text")
    try:
        return content[len(mark) :].decode(encoding)
    except UnicodeDecodeError as error:
        raise Unreadable(
            f"it is not {encoding.upper()} (byte {error.start}): convert it, e.g. iconv -f latin1 -t utf-8"
        ) from error
