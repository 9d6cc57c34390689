"""Similar spelling of sentences: the cosine of their groups of letters."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from typing import TYPE_CHECKING
from zlib import crc32

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

BUCKETS = 2048
"""The groups of letters share this many numbers; a few of them collide, which does little harm."""


class Spelling:
    """Examples as vectors of their letter groups; rare groups weigh more."""

    def __init__(self, examples: Sequence[str]) -> None:
        import numpy as np

        counts = np.zeros((len(examples), BUCKETS), dtype=np.float32)
        for row, text in zip(counts, examples, strict=True):
            for group, count in _groups(text).items():
                row[group] = count
        spread = (counts > 0).sum(axis=0)
        # A group that no example has tells nothing about a text.
        self._rarity = np.where(spread > 0, 1 + np.log(len(examples) / (1 + spread)), 0).astype(np.float32)
        counts *= self._rarity
        counts /= np.maximum(np.linalg.norm(counts, axis=1, keepdims=True), 1e-9)
        self.among = counts @ counts.T
        """The cosine of each example with each other one."""
        self._examples = np.ascontiguousarray(counts.T).astype(np.float16)

    def likeness(self, texts: Sequence[str]) -> NDArray[np.float32]:
        """Return the cosine of each text (rows) with each example (columns); 0 if no group of a text is known."""
        import numpy as np

        likeness = np.zeros((len(texts), self._examples.shape[1]), dtype=np.float32)
        for row, text in enumerate(texts):
            groups = _groups(text)
            places = np.fromiter(groups, dtype=np.intp, count=len(groups))
            weights = np.fromiter(groups.values(), dtype=np.float32, count=len(groups)) * self._rarity[places]
            length = float(np.linalg.norm(weights))
            if length > 0:
                likeness[row] = (weights / length) @ self._examples[places].astype(np.float32)
        return likeness


def _groups(text: str) -> Counter[int]:
    """Return the numbers of the groups of three and four letters, with their counts."""
    code = f" {text} ".encode("utf-8", "replace")
    return Counter(crc32(code[i : i + size]) % BUCKETS for size in (3, 4) for i in range(len(code) - size + 1))
