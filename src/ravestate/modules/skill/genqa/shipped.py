"""The collection that comes with Ravestate, and the functions that add it to an index."""

from __future__ import annotations

import gzip
import hashlib
import json
from collections.abc import Iterator
from importlib.resources import files
from typing import Any

from ravestate.yaml_text import load_yaml

from .document import Document, Passage
from .index import Index, IndexedFile

SHIPPED = "ravestate:collection"
"""The collection's name among the files of an index."""

OWN = "Ravestate's own collection"
"""The source of the sentences that were written for Ravestate."""
_FACTBOOK = "world-factbook.jsonl.gz"
_GENERAL = ("general.yaml", "people.yaml", "nature.yaml", "culture.yaml", "everyday.yaml")


def bring_up(index: Index, *, wanted: bool = True) -> bool:
    """Add this version of the collection to `index`, or remove it if it is not `wanted`.

    Return whether the index has changed. A change takes about a second.

    Raises:
        PlatformError: See `Index.put`.
    """
    known = index.file(SHIPPED)
    if not wanted:
        return known is not None and index.forget(SHIPPED)
    folder = files("ravestate.modules.skill.genqa") / "collection"
    content = [(folder / name).read_bytes() for name in (_FACTBOOK, *_GENERAL)]
    digest = hashlib.blake2b(b"".join(content), digest_size=16).hexdigest()
    if known is not None and known.digest == digest:
        return False
    size = sum(map(len, content))
    index.put(IndexedFile(SHIPPED, size, 0, digest), documents(*content))
    return True


def documents(factbook: bytes, *general: bytes) -> Iterator[Document]:
    """Yield the documents of the collection's files."""
    for line in gzip.decompress(factbook).splitlines():
        entry: dict[str, Any] = json.loads(line)
        yield Document(
            entry["title"],
            entry["source"],
            [Passage(text, f"{entry['also']} {asked}") for text, asked in entry["sentences"]],
        )
    for file in general:
        said: dict[str, list[str]] = load_yaml(file.decode("utf-8"), "collection")
        for title, sentences in said.items():
            yield Document(title, OWN, [Passage(sentence) for sentence in sentences])
