"""Readers for several kinds of files: text, Markdown, HTML, PDF, JSON lines, ZIM."""

from __future__ import annotations

import codecs
import json
import logging
import re
import warnings
from collections.abc import Callable, Iterator
from importlib import import_module
from pathlib import Path
from typing import Any, cast

from .document import Document
from .passages import passages_of

LARGEST = 64 << 20
"""The maximum size of a text, Markdown or HTML file, in bytes. The whole file is held in memory."""
_MARKS = {
    codecs.BOM_UTF8: "utf-8", codecs.BOM_UTF32_LE: "utf-32-le", codecs.BOM_UTF32_BE: "utf-32-be", codecs.BOM_UTF16_LE: "utf-16-le",
    codecs.BOM_UTF16_BE: "utf-16-be",
}  # fmt: skip
_FRONT_MATTER = re.compile(r"\A---\n.*?^---\n", re.MULTILINE | re.DOTALL)
_UNSEEN = (
    "script", "style", "noscript", "template", "nav", "header", "footer", "aside", "form", "svg", "button", "iframe",
)  # fmt: skip
_HEADINGS = {"h1", "h2", "h3", "h4", "h5", "h6"}
_BLOCKS = {
    "p", "div", "section", "article", "main", "li", "ul", "ol", "dl", "dt", "dd", "tr", "table", "blockquote", "pre", "figure",
    "figcaption", "br", "hr", "body",
}  # fmt: skip


class Unreadable(Exception):
    """A file that cannot be read; the message says why, without the file's name."""


def kind_of(path: Path) -> str | None:
    """Return the ending of a file's name, in lower case, if files of this kind can be read; None if they cannot."""
    ending = path.suffix.lower()
    return ending if ending in KINDS else None


def read(path: Path, source: str) -> Iterator[Document]:
    """Yield the documents of a file while reading it.

    Args:
        path: The file; the ending of its name gives its kind.
        source: The source that an answer names.

    Raises:
        Unreadable: The file cannot be read, its ending and its content differ, or a library is missing.
    """
    kind = kind_of(path)
    if kind is None:
        raise Unreadable(f"a file must end in one of {', '.join(KINDS)}, not in {path.suffix!r}")
    try:
        yield from KINDS[kind](path, source)
    except OSError as error:
        raise Unreadable(error.strerror or str(error)) from error
    except RecursionError as error:
        raise Unreadable("it is nested too deeply") from error


def _title(path: Path) -> str:
    return path.stem.replace("_", " ")


def _library(name: str, package: str, kind: str, why: str = "pip install 'ravestate[genqa]'") -> Any:
    try:
        return import_module(name)
    except ImportError as error:
        raise Unreadable(f"genqa needs {package} to read {kind}: {why}") from error


def _content(path: Path) -> bytes:
    if (size := path.stat().st_size) > LARGEST:
        raise Unreadable(f"it has {size >> 20} MB, and a text may have at most {LARGEST >> 20} MB: split it")
    return path.read_bytes()


def _decoded(path: Path) -> str:
    """Return the text of a file: UTF-8, or the encoding of its byte order mark."""
    content = _content(path)
    mark = next((mark for mark in _MARKS if content.startswith(mark)), b"")
    if not mark and b"\0" in content:
        raise Unreadable("it is binary, not text")
    encoding = _MARKS.get(mark, "utf-8")
    try:
        return content[len(mark) :].decode(encoding)
    except UnicodeDecodeError as error:
        raise Unreadable(
            f"it is not {encoding.upper()} (byte {error.start}): convert it, e.g. iconv -f latin1 -t utf-8"
        ) from error


def _text(path: Path, source: str) -> Iterator[Document]:
    yield Document(_title(path), source, passages_of(_decoded(path)))


def _markdown(path: Path, source: str) -> Iterator[Document]:
    library = _library("markdown_it", "markdown-it-py", "Markdown")
    text = _FRONT_MATTER.sub("", _decoded(path).replace("\r\n", "\n"), count=1)
    parser = library.MarkdownIt("commonmark").enable("table").disable("code")  # indented text is mostly prose
    page = re.sub(r"<pre>.*?</pre>", "", parser.render(text), flags=re.DOTALL)  # drop code
    return documents_in(page, _title(path), source, top="")


def _html(path: Path, source: str) -> Iterator[Document]:
    content = _content(path)
    if b"\0" in content and not content.startswith((b"\xff\xfe", b"\xfe\xff")):
        raise Unreadable("it is binary, not HTML")
    return documents_in(content, _title(path), source)


def documents_in(content: bytes | str, title: str, source: str, top: str | None = None) -> Iterator[Document]:
    """Yield the documents of a page: the text before the first heading, and the text after each heading.

    Args:
        content: The page; bytes may be in any encoding that the page declares.
        title: The title, if the page has none of its own.
        source: The source that an answer names.
        top: The first part of each document's title; by default the page's title. If it is empty, titles begin with a
            heading.

    Raises:
        Unreadable: beautifulsoup4 is not installed.
    """
    bs4 = _library("bs4", "beautifulsoup4", "HTML")
    logging.getLogger("bs4.dammit").setLevel(logging.ERROR)  # bs4's warnings about characters do not name the file
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # bs4 warns about XML, and about texts that look like file names
        page: Any = bs4.BeautifulSoup(content, "html.parser")
    for hidden in [*page.find_all(_UNSEEN), *page.find_all(hidden=True)]:
        hidden.decompose()
    for image in page.find_all("img", alt=True):
        image.replace_with(image["alt"])
    if page.title is not None and page.title.get_text(strip=True):
        title = " ".join(page.title.get_text().split())
    above: list[tuple[int, str]] = []
    pieces: list[str] = []

    def named() -> str:
        parts = [title if top is None else top, *(text for _, text in above)]
        return " – ".join(dict.fromkeys(filter(None, parts))) or title

    for node in (page.body or page).descendants:
        if isinstance(node, bs4.element.PreformattedString) or (node.parent and node.parent.name == "title"):
            continue  # skip comments and declarations
        if isinstance(node, bs4.element.NavigableString):
            if not any(parent.name in _HEADINGS for parent in node.parents):
                pieces.append(" ".join(node.split("\n")) if node.strip() else " ")
        elif node.name in _HEADINGS:
            yield Document(named(), source, passages_of("".join(pieces)))
            pieces = []
            level = int(node.name[1])
            above = [*(pair for pair in above if pair[0] < level), (level, " ".join(node.get_text().split()))]
        elif node.name in _BLOCKS:
            pieces.append("\n\n")
        elif node.name in ("td", "th"):
            pieces.append(" ")
    yield Document(named(), source, passages_of("".join(pieces)))


def _pdf(path: Path, source: str) -> Iterator[Document]:
    """Yield a document for each page; the document's source names the page."""
    library = _library("pypdf", "pypdf", "PDF")
    logging.getLogger("pypdf").setLevel(logging.ERROR)  # pypdf warns about every oddity that it can handle
    try:
        reader = library.PdfReader(path)
        if reader.is_encrypted and not reader.decrypt(""):
            raise Unreadable("it is encrypted: remove its password first")
        title = str((reader.metadata and reader.metadata.title) or "").strip() or _title(path)
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


def _jsonl(path: Path, source: str) -> Iterator[Document]:
    """Yield a document for each line, ``{"title": "...", "text": "...", "source": "..."}``.

    Only the text is required; its key may also be ``contents``. Empty lines are skipped.
    """
    with path.open("rb") as lines:
        for number, line in enumerate(lines, start=1):
            if not line.strip():
                continue
            try:
                said: Any = json.loads(line)
            except ValueError as error:  # the line is not JSON, or not UTF-8
                raise Unreadable(f"line {number} is not JSON ({error})") from error
            entry = cast("dict[str, Any]", said) if isinstance(said, dict) else {}
            text = entry.get("text", entry.get("contents"))
            if not isinstance(text, str):
                raise Unreadable(f'line {number} has no text: write {{"title": "...", "text": "..."}}')
            title = str(entry.get("title") or _title(path))
            yield Document(title, str(entry.get("source") or f"{source}, {title}"), passages_of(text))


def _zim(path: Path, source: str) -> Iterator[Document]:
    """Yield the documents of each article in a ZIM file, the format of Kiwix; skip redirects, pictures and other files."""
    why = "pip install libzim (it is under the GPL, so you install it yourself)"
    reader = _library("libzim.reader", "libzim", "ZIM", why)
    try:
        archive = reader.Archive(path)
        count: int = archive.all_entry_count
    except RuntimeError as error:
        raise Unreadable(f"it is not a ZIM file, or damaged ({error})") from error
    for number in range(count):
        try:
            entry = archive._get_entry_by_id(number)  # libzim has no other way to go through all entries
            item = None if entry.is_redirect else entry.get_item()
            if item is None or not item.mimetype.startswith("text/html"):
                continue
            title, content = entry.title, bytes(item.content)
        except (RuntimeError, KeyError) as error:
            raise Unreadable(f"its entry {number} is damaged ({error})") from error
        yield from documents_in(content, title, f"{source}, {title}")


KINDS: dict[str, Callable[[Path, str], Iterator[Document]]] = {
    ".txt": _text, ".text": _text, ".md": _markdown, ".markdown": _markdown, ".html": _html, ".htm": _html, ".xhtml": _html,
    ".pdf": _pdf, ".jsonl": _jsonl, ".ndjson": _jsonl, ".zim": _zim,
}  # fmt: skip
"""The reader for each ending of a file's name."""
