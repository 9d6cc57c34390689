"""Compare the spelling of sentences, by the cosine of their groups of letters."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

BUCKETS = 2048
"""The number of buckets into which groups of letters are hashed. A few groups collide; that does little harm."""
REMEMBERED = 256
"""The number of texts whose groups are kept, because all matchers ask for the same texts."""
_HASH, _SHIFT = 2654435761, 21
"""The factor of Knuth's multiplicative hash, and the shift that keeps the upper 11 of its 32 bits."""


class Spelling:
    """Compares texts with examples by their letter groups; rare groups weigh more."""

    def __init__(self, examples: Sequence[str]) -> None:
        import numpy as np

        counts = _counts(examples)
        spread = (counts > 0).sum(axis=0)
        # Groups of letters that no example has get the weight 0.
        self._rarity = np.where(spread > 0, 1 + np.log(len(examples) / (1 + spread)), 0).astype(np.float32)
        vectors = self._vectors(counts)
        buckets, self._examples = np.nonzero(vectors.T)
        self._weights = vectors[self._examples, buckets].astype(np.float16)
        self._examples = self._examples.astype(np.int32)
        self._starts = np.searchsorted(buckets, np.arange(BUCKETS + 1)).tolist()
        self._size = len(examples)

    def among(self) -> NDArray[np.float32]:
        """Return the cosine of each pair of examples."""
        import numpy as np

        vectors = np.zeros((self._size, BUCKETS), dtype=np.float32)
        vectors[self._examples, np.repeat(np.arange(BUCKETS), np.diff(self._starts))] = self._weights
        return vectors @ vectors.T

    def likeness(self, texts: Sequence[str]) -> NDArray[np.float32]:
        """Return the cosine of each text (rows) with each example (columns); 0 for a text without a known group."""
        import numpy as np

        likeness = np.zeros((len(texts), self._size), dtype=np.float32)
        for row, text in zip(likeness, texts, strict=True):
            buckets, counts = _groups(text)
            weights = counts * self._rarity[buckets]
            weights /= max(float(np.linalg.norm(weights)), 1e-9)
            listed = [slice(self._starts[bucket], self._starts[bucket + 1]) for bucket in buckets.tolist()]
            if not listed:
                continue
            examples = np.concatenate([self._examples[part] for part in listed])
            products = np.concatenate([self._weights[part] for part in listed]).astype(np.float32)
            products *= np.repeat(weights, [part.stop - part.start for part in listed])
            row[:] = np.bincount(examples, products, minlength=self._size)
        return likeness

    def _vectors(self, counts: NDArray[np.float32]) -> NDArray[np.float32]:
        import numpy as np

        weighted = counts * self._rarity
        return weighted / np.maximum(np.linalg.norm(weighted, axis=1, keepdims=True), np.float32(1e-9))


@lru_cache(maxsize=REMEMBERED)
def _groups(text: str) -> tuple[NDArray[np.intp], NDArray[np.float32]]:
    """Return the buckets of a text, and the number of its groups in each bucket."""
    import numpy as np

    [counts] = _counts([text])
    buckets = np.flatnonzero(counts)
    return buckets, counts[buckets]


def _counts(texts: Sequence[str]) -> NDArray[np.float32]:
    """Count the groups of three and four letters (columns) in each text (rows)."""
    import numpy as np

    codes = [f" {text} ".replace("\n", " ").encode("utf-8", "replace") for text in texts]
    letters = np.frombuffer(b"\n".join(codes) + b"\n\n\n\n", dtype=np.uint8).astype(np.uint32)
    rows = np.repeat(np.arange(len(texts)), [len(code) + 1 for code in codes])
    counts = np.zeros((len(texts), BUCKETS), dtype=np.float32)
    group, whole = np.zeros_like(letters), np.ones(len(letters), dtype=np.bool_)
    for size in (1, 2, 3, 4):
        shifted = letters[size - 1 :]
        group, whole = group[: len(shifted)] * np.uint32(257) + shifted, whole[: len(shifted)] & (shifted != 10)
        if size > 2:
            places = np.flatnonzero(whole[: len(rows)])
            np.add.at(counts, (rows[places], (group[places] * np.uint32(_HASH)) >> np.uint32(_SHIFT)), 1)
    return counts
