"""A reader for HTML: the visible text of a page, one document per heading."""

from __future__ import annotations

import logging
import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from ..document import Document
from ..passages import passages_of
from .text import LARGEST
from .unreadable import Unreadable

_UNSEEN = (
    "script", "style", "noscript", "template", "nav", "header", "footer", "aside", "form", "svg", "button", "iframe",
)  # fmt: skip
_BLOCKS = {
    "p", "div", "section", "article", "main", "li", "ul", "ol", "dl", "dt", "dd", "tr", "table", "blockquote", "pre", "figure",
    "figcaption", "br", "hr", "body",
}  # fmt: skip
_HEADINGS = {"h1", "h2", "h3", "h4", "h5", "h6"}


def read(path: Path, source: str) -> Iterator[Document]:
    """Yield a document for each heading."""
    if (size := path.stat().st_size) > LARGEST:
        raise Unreadable(f"it has {size >> 20} MB, and a page may have {LARGEST >> 20}")
    content = path.read_bytes()
    if b"\0" in content and not content.startswith((b"\xff\xfe", b"\xfe\xff")):
        raise Unreadable("it is binary, not HTML")
    yield from documents_in(content, path.stem.replace("_", " "), source)


def documents_in(content: bytes | str, title: str, source: str) -> Iterator[Document]:
    """Yield the documents of a page.

    Args:
        content: The page; bytes in any encoding that it declares.
        title: The title, if the page has none of its own.
        source: The source that answers name.

    Raises:
        Unreadable: beautifulsoup4 is not installed.
    """
    try:
        import bs4
    except ImportError as error:
        raise Unreadable("genqa needs beautifulsoup4 to read HTML: pip install 'ravestate[genqa]'") from error
    logging.getLogger("bs4.dammit").setLevel(logging.ERROR)  # its warnings about characters do not name the file
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # it warns about XML, and about texts that look like file names
        page: Any = bs4.BeautifulSoup(content, "html.parser")
    for hidden in page.find_all(_UNSEEN):
        hidden.decompose()
    for hidden in page.find_all(hidden=True):
        hidden.decompose()
    if page.title is not None and page.title.get_text(strip=True):
        title = " ".join(page.title.get_text().split())
    above: list[tuple[int, str]] = []
    pieces: list[str] = []
    for node in (page.body or page).descendants:
        if isinstance(node, bs4.element.PreformattedString) or (node.parent and node.parent.name == "title"):
            continue  # comments, declarations
        if isinstance(node, bs4.element.NavigableString):
            if not any(parent.name in _HEADINGS for parent in node.parents):
                pieces.append(" ".join(node.split("\n")) if node.strip() else " ")
        elif node.name in _HEADINGS:
            yield Document(_title(title, above), source, passages_of("".join(pieces)))
            pieces = []
            level = int(node.name[1])
            above = [*(pair for pair in above if pair[0] < level), (level, " ".join(node.get_text().split()))]
        elif node.name in _BLOCKS:
            pieces.append("\n\n")
        elif node.name in ("td", "th"):
            pieces.append(" ")
    yield Document(_title(title, above), source, passages_of("".join(pieces)))


def _title(page: str, above: list[tuple[int, str]]) -> str:
    parts = [page, *(text for _, text in above if text)]
    return " – ".join(dict.fromkeys(parts))
