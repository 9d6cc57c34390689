"""Markdown: what a reader sees of it, heading by heading."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

from ..document import Document
from ..passages import passages_of
from .text import decoded

__all__ = ["read"]

_FENCE = re.compile(r"^(```|~~~).*?^\1[ \t]*$", re.MULTILINE | re.DOTALL)
_COMMENT = re.compile(r"<!--.*?-->", re.DOTALL)
_FRONT = re.compile(r"\A---\n.*?^---\n", re.MULTILINE | re.DOTALL)
_HEADING = re.compile(r"^(#{1,6})[ \t]+(.+?)[ \t#]*$", re.MULTILINE)
_ITEM = re.compile(r"^[ \t]*(?:[-*+]|\d+[.)])[ \t]+", re.MULTILINE)
_TABLE = re.compile(r"^[ \t]*\|(.*)\|[ \t]*$", re.MULTILINE)
_RULE = re.compile(r"^[ \t|:*_=-]+$", re.MULTILINE)


def read(path: Path, source: str) -> Iterator[Document]:
    """A document for each heading; its title is the headings that stand above it."""
    text = _FRONT.sub("", decoded(path).replace("\r\n", "\n"), count=1)
    text = _COMMENT.sub("", _FENCE.sub("", text))
    above: list[str] = []
    start, title = 0, path.stem.replace("_", " ")
    for heading in _HEADING.finditer(text):
        yield Document(title, source, passages_of(_seen(text[start : heading.start()])))
        above = [*above[: len(heading[1]) - 1], _inline(heading[2])]
        start, title = heading.end(), " – ".join(above)
    yield Document(title, source, passages_of(_seen(text[start:])))


def _seen(text: str) -> str:
    """`text` without marks; items of lists and rows of tables are paragraphs of their own."""
    text = _RULE.sub("", text)
    text = _TABLE.sub(lambda row: "\n" + ", ".join(cell.strip() for cell in row[1].split("|")) + "\n", text)
    text = _ITEM.sub("\n", text)
    return _inline(re.sub(r"^[ \t]*>[ \t]?", "", text, flags=re.MULTILINE))


def _inline(text: str) -> str:
    text = re.sub(r"!\[([^\]]*)\]\([^)]*\)", r"\1", text)
    text = re.sub(r"\[([^\]]*)\](?:\([^)]*\)|\[[^\]]*\])", r"\1", text)
    text = re.sub(r"</?[a-zA-Z][^>]*>", "", text)
    text = re.sub(r"(\*\*|__|\*|`+)(?=\S)(.+?)(?<=\S)\1", r"\2", text)
    return re.sub(r"\\([\\`*_{}\[\]()#+.!|-])", r"\1", text).strip(" ")
