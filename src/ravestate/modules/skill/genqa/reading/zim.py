"""A reader for ZIM, the files of Kiwix (Wikipedia, Wiktionary and others for reading offline)."""

from __future__ import annotations

from collections.abc import Iterator
from importlib import import_module
from pathlib import Path
from typing import Any

from ..document import Document
from .html import documents_in
from .unreadable import Unreadable


def read(path: Path, source: str) -> Iterator[Document]:
    """Yield the documents of each article; skip redirects and pictures."""
    try:
        reader: Any = import_module("libzim.reader")
    except ImportError as error:
        raise Unreadable(
            "genqa needs libzim to read ZIM: pip install libzim (it is under the GPL, so you install it yourself)"
        ) from error
    try:
        archive = reader.Archive(path)
        count: int = archive.all_entry_count
    except RuntimeError as error:
        raise Unreadable(f"it is not a ZIM file, or damaged ({error})") from error
    for number in range(count):
        try:
            entry = archive._get_entry_by_id(number)  # libzim has no other way to go through all of them
            if entry.is_redirect:
                continue
            item = entry.get_item()
            if not item.mimetype.startswith("text/html"):
                continue
            title, content = entry.title, bytes(item.content)
        except (RuntimeError, KeyError) as error:
            raise Unreadable(f"its entry {number} is damaged ({error})") from error
        yield from documents_in(content, title, f"{source}, {title}")
