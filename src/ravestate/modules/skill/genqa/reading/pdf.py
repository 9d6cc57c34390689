"""A reader for PDF: the text of its pages."""

from __future__ import annotations

import logging
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from ..document import Document
from ..passages import passages_of
from .unreadable import Unreadable


def read(path: Path, source: str) -> Iterator[Document]:
    """Yield a document for each page; its source names the page."""
    try:
        import pypdf
    except ImportError as error:
        raise Unreadable("genqa needs pypdf to read PDF: pip install 'ravestate[genqa]'") from error
    library: Any = pypdf
    logging.getLogger("pypdf").setLevel(logging.ERROR)  # it warns about every oddity that it can handle
    try:
        reader = library.PdfReader(path)
        if reader.is_encrypted and not reader.decrypt(""):
            raise Unreadable("it is encrypted: remove its password first")
        title = str((reader.metadata and reader.metadata.title) or "").strip() or path.stem.replace("_", " ")
        seen = False
        for number, page in enumerate(reader.pages, start=1):
            text = page.extract_text() or ""
            seen = seen or bool(text.strip())
            yield Document(title, f"{source}, page {number}", passages_of(text))
    except (Unreadable, OSError, RecursionError):
        raise
    except Exception as error:  # a broken file makes pypdf fail in any way
        if type(error).__name__ == "DependencyError":
            raise Unreadable("it is encrypted: remove its password first") from error
        raise Unreadable(f"it is not a PDF, or damaged ({str(error) or type(error).__name__})") from error
    if not seen:
        raise Unreadable("it has no text, only pictures: run a text recognition (OCR) on it first")
