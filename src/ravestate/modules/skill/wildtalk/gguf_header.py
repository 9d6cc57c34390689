"""The header of a GGUF file: the model's architecture, the number of its parameters, and whether it can chat.

GGUF is the format of models for llama.cpp.

The package ``gguf`` reads every token of the vocabulary, which takes seconds per file. This reader skips the tokens.
The format: https://github.com/ggml-org/ggml/blob/master/docs/gguf.md
"""

from __future__ import annotations

import functools
import math
import mmap
import struct
from dataclasses import dataclass
from pathlib import Path
from typing import Any

LARGEST = 64 << 20
"""The maximum size of a header in bytes; the headers with the largest vocabularies have a quarter of this size."""

_STRING, _ARRAY = 8, 9
_NUMBERS: dict[int, str] = dict(zip((0, 1, 2, 3, 4, 5, 6, 7, 10, 11, 12), "BbHhIif?Qqd", strict=True))


@dataclass(frozen=True, slots=True)
class GgufHeader:
    """Facts about a model, from the header of its file."""

    architecture: str
    parameters: int
    chats: bool
    """Whether it is a chat model: it has a chat template, and it does not pool its output into an embedding."""


def read_header(path: Path) -> GgufHeader:
    """Return the header of a GGUF file. An unchanged file is read once per process.

    Raises:
        OSError: The file cannot be read.
        ValueError: The file is not a complete GGUF file.
    """
    status = path.stat()
    return _read(path, status.st_size, status.st_mtime_ns)


@functools.lru_cache(maxsize=256)
def _read(path: Path, size: int, _: int) -> GgufHeader:
    try:
        with path.open("rb") as file, mmap.mmap(file.fileno(), min(size, LARGEST), access=mmap.ACCESS_READ) as data:
            header, last = _Reader(data).header()
    except (struct.error, KeyError, OverflowError, ValueError) as error:
        raise ValueError(f"{path} is not a complete GGUF file") from error
    if last >= size:
        raise ValueError(f"{path} is cut short")
    return header


class _Reader:
    def __init__(self, data: mmap.mmap) -> None:
        self._data = data
        self._at = 0

    def header(self) -> tuple[GgufHeader, int]:
        """Return the header, and the offset of the last tensor, in bytes."""
        magic, version, tensors, keys = self._numbers("4sIQQ")
        if magic != b"GGUF" or version not in (2, 3) or not tensors:
            raise ValueError
        facts = {self._text(): self._value(*self._numbers("I")) for _ in range(keys)}
        parameters = last = 0
        for _ in range(tensors):
            self._text()
            parameters += math.prod(self._numbers("Q" * self._numbers("I")[0]))
            last = max(last, self._numbers("IQ")[1])
        chats = "tokenizer.chat_template" in facts and not any(key.endswith(".pooling_type") for key in facts)
        model = facts.get("general.type", "model") == "model"
        return GgufHeader(facts.get("general.architecture", ""), parameters, model and chats), last

    def _numbers(self, form: str) -> tuple[Any, ...]:
        found = struct.unpack_from(f"<{form}", self._data, self._at)
        self._at += struct.calcsize(f"<{form}")
        return found

    def _text(self) -> str:
        (length,) = self._numbers("Q")
        self._at += length
        return self._data[self._at - length : self._at].decode("utf-8", "replace")

    def _value(self, kind: int) -> Any:
        """Return a value. If it is an array, skip it, and return None."""
        if kind == _STRING:
            return self._text()
        if kind != _ARRAY:
            return self._numbers(_NUMBERS[kind])[0]
        each, count = self._numbers("IQ")
        if each != _STRING:
            self._at += count * struct.calcsize(_NUMBERS[each])
            return None
        for _ in range(count):
            (length,) = self._numbers("Q")
            self._at += length
        return None
