"""A reader for Markdown: one document per heading, without marks and code."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from html import unescape
from pathlib import Path
from typing import TYPE_CHECKING

from ..document import Document
from ..passages import passages_of
from .text import decoded
from .unreadable import Unreadable

if TYPE_CHECKING:
    from markdown_it.token import Token

# A tag is near its end: without the limit, a file of opening brackets would take for ever.
_UNSEEN = re.compile(
    r"<!--.*?(?:-->|\Z)|<(script|style)\b.*?(?:</\1>|\Z)|</?\w[^<>]{0,300}>", re.DOTALL | re.IGNORECASE
)
_FRONT_MATTER = re.compile(r"\A---\n.*?^---\n", re.MULTILINE | re.DOTALL)


def read(path: Path, source: str) -> Iterator[Document]:
    """Yield a document for each heading; its title joins the headings above it.

    Raises:
        Unreadable: The file is not text, or markdown-it-py is not installed.
    """
    try:
        from markdown_it import MarkdownIt
    except ImportError as error:
        raise Unreadable("genqa needs markdown-it-py to read Markdown: pip install 'ravestate[genqa]'") from error
    parser = MarkdownIt("commonmark").enable("table").disable("code")  # indented text is mostly prose
    text = _FRONT_MATTER.sub("", decoded(path).replace("\r\n", "\n"), count=1)
    title, above = path.stem.replace("_", " "), list[str]()
    blocks, cells = list[str](), list[str]()
    heading, in_row = 0, False
    for token in parser.parse(text):
        if token.type == "heading_open":
            yield Document(title, source, passages_of("\n\n".join(blocks)))
            blocks.clear()
            heading = int(token.tag[1])
        elif token.type == "inline" and heading:
            above = [*above[: heading - 1], _visible(token.children or ()).strip()]
            title, heading = " – ".join(above), 0
        elif token.type == "inline":
            (cells if in_row else blocks).append(_visible(token.children or ()))
        elif token.type == "html_block":
            blocks.append(unescape(_UNSEEN.sub("", token.content)))
        elif token.type == "tr_open":
            in_row = True
        elif token.type == "tr_close":
            blocks.append(", ".join(cells))
            cells.clear()
            in_row = False
    yield Document(title, source, passages_of("\n\n".join(blocks)))


def _visible(tokens: Sequence[Token]) -> str:
    """Return the text that a reader sees; an image counts with its description."""
    return "".join(
        "\n" if token.type.endswith("break") else "" if token.type == "html_inline" else token.content
        for token in tokens
    )
