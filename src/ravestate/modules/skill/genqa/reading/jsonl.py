"""A reader for JSON lines: a document per line, ``{"title": "...", "text": "...", "source": "..."}``."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any, cast

from ..document import Document
from ..passages import passages_of
from .unreadable import Unreadable


def read(path: Path, source: str) -> Iterator[Document]:
    """Yield a document for each line; only ``text`` is required."""
    with path.open("rb") as lines:
        for number, line in enumerate(lines, start=1):
            if not line.strip():
                continue
            try:
                said: Any = json.loads(line)
            except ValueError as error:  # of JSON, of UTF-8
                raise Unreadable(f"line {number} is not JSON ({error})") from error
            entry = cast("dict[str, Any]", said) if isinstance(said, dict) else {}
            text = entry.get("text", entry.get("contents"))
            if not isinstance(text, str):
                raise Unreadable(f'line {number} has no text: write {{"title": "...", "text": "..."}}')
            title = str(entry.get("title") or path.stem.replace("_", " "))
            yield Document(title, str(entry.get("source") or f"{source}, {title}"), passages_of(text))
