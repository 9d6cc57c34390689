"""Markdown: what a reader sees of it, heading by heading."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

from ..document import Document
from ..passages import passages_of
from .text import decoded

__all__ = ["read"]

_FENCE = re.compile(r"^[ ]{0,3}(```|~~~)", re.MULTILINE)
_FRONT = re.compile(r"\A---\n.*?^---\n", re.MULTILINE | re.DOTALL)
_HEADING = re.compile(r"^(#{1,6})[ \t]+(.+?)[ \t#]*$", re.MULTILINE)
_ITEM = re.compile(r"^[ \t]*(?:[-*+]|\d+[.)])[ \t]+", re.MULTILINE)
_TABLE = re.compile(r"^[ \t]*\|(.*)\|[ \t]*$", re.MULTILINE)
_RULE = re.compile(r"^[ \t|:*_=-]+$", re.MULTILINE)


def read(path: Path, source: str) -> Iterator[Document]:
    """A document for each heading; its title is the headings that stand above it."""
    text = _FRONT.sub("", decoded(path).replace("\r\n", "\n"), count=1)
    text = _without_comments(_without_fences(text))
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


def _without_fences(text: str) -> str:
    """`text` without blocks of code."""
    kept, open_mark = list[str](), ""
    for line in text.split("\n"):
        fence = _FENCE.match(line)
        if fence is None:
            kept += [] if open_mark else [line]
        elif not open_mark:
            open_mark = fence[1]
        elif fence[1] == open_mark:
            open_mark = ""
    return "\n".join(kept)


def _without_comments(text: str) -> str:
    kept, start = list[str](), 0
    while (opened := text.find("<!--", start)) >= 0 and (closed := text.find("-->", opened)) >= 0:
        kept.append(text[start:opened])
        start = closed + 3
    return "".join(kept) + text[start:]


# What belongs together is near: each pattern looks so far and no farther, or a file of opening brackets takes for ever.
_PICTURE = re.compile(r"!\[([^\]\n]{0,300})\]\([^)\n]{0,500}\)")
_LINK = re.compile(r"\[([^\]\n]{0,300})\](?:\([^)\n]{0,500}\)|\[[^\]\n]{0,300}\])")
_TAG = re.compile(r"</?[a-zA-Z][^<>\n]{0,300}>")
_EMPHASIS = re.compile(r"(?<!\\)(\*\*|__|\*|`{1,3})(?=\S)([^\n]{1,300}?)(?<![\s\\])\1")
_ESCAPED = re.compile(r"\\([\\`*_{}\[\]()#+.!|-])")


def _inline(text: str) -> str:
    text = _TAG.sub("", _LINK.sub(r"\1", _PICTURE.sub(r"\1", text)))
    return _ESCAPED.sub(r"\1", _EMPHASIS.sub(r"\2", text)).strip(" ")
