"""Texts as the network sees them, and batches of them."""

from __future__ import annotations

import hashlib
import random
from collections.abc import Callable, Iterable, Sequence
from typing import Any

import numpy as np

from ravestate.language.encoder import BUNDLED
from ravestate.language.model import model_in
from ravestate.language.network import BEFORE, EARLIER, SAID

KEPT = 0.7
"""The chance that a text is read together with each of the texts before it. The network must also work without them."""
LAYERS, WIDTH = 5, 384
"""The number of layers of which a token has a vector, and the length of a vector."""


class Row:
    """A text as the network sees it: the vectors of its tokens, and the classes to learn."""

    def __init__(self, text: str, longest: int = 64) -> None:
        """Read the first tokens of a text, at most `longest`."""
        spans, vectors = model_in(None, BUNDLED).token_vectors(text)
        self.spans = spans[:longest]
        self.vectors = vectors[:longest].astype(np.float16)
        """The vectors: shape (tokens, LAYERS * WIDTH)."""
        self.marks = [int(start < end and text[start].isupper()) for start, end in self.spans]
        self.before: Row | None = None
        """The utterance before, in a talk."""
        self.said: Row | None = None
        """The agent's answer to the utterance before."""
        self.asked = 0
        """The fact that the agent has asked for, counted from 1; 0 for none."""
        self.head = ""
        """The name of the head that learns from the text."""
        self.classes: list[int] = []
        self.wrong: list[int] = []
        """Classes that do not suit."""
        self.denied: list[float] = []
        self.grades: list[tuple[int, int]] = []
        """Pairs of a reply's index and its grade."""
        self.weight = 1.0

    def __len__(self) -> int:
        return len(self.spans) + sum(min(BEFORE, len(one.spans)) for one in (self.before, self.said) if one)


def digest(files: Iterable[Any]) -> str:
    """Return a short hash of the contents of some files."""
    found = hashlib.sha256()
    for file in sorted(files):
        found.update(file.read_bytes())
    return found.hexdigest()[:16]


def batches(rows: Sequence[Row], size: int, order: random.Random) -> list[list[Row]]:
    """Return the rows in batches of similar length, because padding costs time."""
    ordered = sorted(rows, key=lambda row: len(row) + order.random() * 5)
    return [ordered[at : at + size] for at in range(0, len(ordered), size)]


def padded(torch: Any, rows: Sequence[Row]) -> tuple[Any, Any, Any, Any]:
    """Return the vectors, the marks, the facts asked for, and the padding of some rows: the inputs of the trunk."""
    parts = [_with_earlier(row, lambda: torch.rand(1).item() < KEPT) for row in rows]
    longest = max(len(marks) for _, marks in parts)
    vectors = torch.zeros(len(rows), longest, LAYERS * WIDTH)
    marks = torch.zeros((len(rows), longest), dtype=torch.long)
    padding = torch.ones((len(rows), longest), dtype=torch.bool)
    for number, (one, marked) in enumerate(parts):
        vectors[number, : len(marked)] = torch.from_numpy(one.astype(np.float32))
        marks[number, : len(marked)] = torch.tensor(marked)
        padding[number, : len(marked)] = False
    return vectors, marks, torch.tensor([row.asked for row in rows]), padding


def _with_earlier(row: Row, kept: Callable[[], bool]) -> tuple[Any, list[int]]:
    """Return the vectors and the marks of a text, after those of the texts before it that `kept` chooses."""
    vectors, marks = row.vectors, row.marks
    for one, mark in ((row.said, SAID), (row.before, EARLIER)):
        if one is not None and kept():
            earlier = one.vectors[:BEFORE]
            vectors, marks = np.concatenate([earlier, vectors]), [mark] * len(earlier) + marks
    return vectors, marks
