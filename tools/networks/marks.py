"""Read sentences with marked values: ``[asked home] near [Leeds:home], not in [Rome:not home]``."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

_ASKED = re.compile(r"\[asked ([a-z]+)\] ")
_MARK = re.compile(r"\[([^\[\]]*):(not )?([a-z]+)\]")


@dataclass(frozen=True)
class Value:
    """A marked value."""

    start: int
    end: int
    label: str
    negated: bool


@dataclass(frozen=True)
class Marked:
    """A text and the values in it."""

    text: str
    values: tuple[Value, ...] = ()
    context: str = ""
    """The topic that the agent has asked for; empty if it has asked nothing."""


def marked(line: str) -> Marked:
    """Return the text of a line without its marks, and the values."""
    asked = _ASKED.match(line)
    line = line[asked.end() :] if asked else line
    text, last, values = "", 0, list[Value]()
    for mark in _MARK.finditer(line):
        text += line[last : mark.start()]
        values.append(Value(len(text), len(text) + len(mark[1]), mark[3], bool(mark[2])))
        text += mark[1]
        last = mark.end()
    return Marked(text + line[last:], tuple(values), asked[1] if asked else "")


def read(files: Iterable[Path]) -> Iterator[Marked]:
    """Yield the lines of some files, without empty lines and comments."""
    for file in files:
        for line in file.read_text(encoding="utf-8").splitlines():
            if line.strip() and not line.startswith("#"):
                yield marked(line.strip())
