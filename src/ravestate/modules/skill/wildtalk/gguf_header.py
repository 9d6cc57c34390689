"""The header of a GGUF file: its architecture, the number of its parameters, and whether it can chat.

The package ``gguf`` keeps every token of the vocabulary, which takes seconds per file. This reader skips them.
The format: https://github.com/ggml-org/ggml/blob/master/docs/gguf.md
"""

from __future__ import annotations

import functools
import math
import struct
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO

LARGEST = 64 << 20
"""The maximum size of a header in bytes; the largest vocabularies take a quarter of it."""

_STRING, _ARRAY = 8, 9
_NUMBERS: dict[int, str] = dict(zip((0, 1, 2, 3, 4, 5, 6, 7, 10, 11, 12), "BbHhIif?Qqd", strict=True))
_POOLING, _CHAT_TEMPLATE = ".pooling_type", "tokenizer.chat_template"
_KEPT = ("general.architecture", "general.type")


@dataclass(frozen=True, slots=True)
class GgufHeader:
    """The facts about a model that its header states."""

    architecture: str
    parameters: int
    chats: bool
    """Whether it is a chat model: it has a chat template, and it does not pool its output into an embedding."""


def read_header(path: Path) -> GgufHeader:
    """Return the header of a GGUF file. An unchanged file is read once per process.

    Raises:
        OSError: The file cannot be read.
        ValueError: It is not a complete GGUF file.
    """
    status = path.stat()
    return _read(path, status.st_size, status.st_mtime_ns)


@functools.lru_cache(maxsize=256)
def _read(path: Path, size: int, _: int) -> GgufHeader:
    with path.open("rb", buffering=1 << 20) as file:
        try:
            return _Reader(file, size).header()
        except (struct.error, KeyError) as error:
            raise ValueError(f"{path} is not a complete GGUF file") from error


class _Reader:
    def __init__(self, file: BinaryIO, size: int) -> None:
        self._file = file
        self._size = size
        self._left = LARGEST

    def header(self) -> GgufHeader:
        if self._bytes(4) != b"GGUF" or self._number("I") not in (2, 3):
            raise ValueError("it is not a GGUF file of version 2 or 3")
        tensors, keys = self._number("Q"), self._number("Q")
        facts: dict[str, str] = {}
        pools = chats = False
        for _ in range(keys):
            key, kind = self._text(), self._number("I")
            if kind == _STRING and key in _KEPT:
                facts[key] = self._text()
                continue
            chats = chats or key == _CHAT_TEMPLATE
            pools = pools or key.endswith(_POOLING)
            self._skip(kind)
        parameters = last = 0
        for _ in range(tensors):
            self._skip(_STRING)
            parameters += math.prod(self._number("Q") for _ in range(self._number("I")))
            self._number("I")
            last = max(last, self._number("Q"))
        if not tensors or last >= self._size:
            raise ValueError("the file is cut short")
        model = facts.get("general.type", "model") == "model"
        return GgufHeader(facts.get("general.architecture", ""), parameters, model and chats and not pools)

    def _bytes(self, count: int) -> bytes:
        self._left -= count
        if self._left < 0:
            raise ValueError("the header is too large")
        return self._file.read(count)

    def _number(self, kind: str) -> int:
        return struct.unpack(f"<{kind}", self._bytes(struct.calcsize(f"<{kind}")))[0]

    def _text(self) -> str:
        return self._bytes(self._number("Q")).decode("utf-8", "replace")

    def _skip(self, kind: int) -> None:
        if kind == _STRING:
            self._bytes(self._number("Q"))
        elif kind == _ARRAY:
            each, count = self._number("I"), self._number("Q")
            if each in _NUMBERS:
                self._bytes(count * struct.calcsize(f"<{_NUMBERS[each]}"))
            elif each == _STRING:
                for _ in range(count):
                    self._bytes(self._number("Q"))
            else:
                raise ValueError("the header has nested arrays")
        else:
            self._number(_NUMBERS[kind])
