"""Similar spelling of sentences: the cosine of their groups of letters."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


class Spelling:
    """Examples as vectors of their letter groups; rare groups weigh more."""

    def __init__(self, examples: Sequence[str]) -> None:
        import numpy as np

        counted = [Counter(_groups(text)) for text in examples]
        spread = Counter(group for groups in counted for group in groups)
        self._examples = len(examples)
        self._rarity = {group: 1 + math.log(len(examples) / (1 + count)) for group, count in spread.items()}
        # An inverted index: for each group the examples that have it, and its weight in each.
        where: dict[str, list[int]] = {}
        shares: dict[str, list[float]] = {}
        for example, groups in enumerate(counted):
            for group, value in self._vector(groups).items():
                where.setdefault(group, []).append(example)
                shares.setdefault(group, []).append(value)
        self._found = {
            group: (np.array(where[group], dtype=np.int32), np.array(shares[group], dtype=np.float32))
            for group in where
        }

    def likeness(self, texts: Sequence[str]) -> NDArray[np.float32]:
        """Return the cosine of each text (rows) with each example (columns); 0 if no group of a text is known."""
        import numpy as np

        likeness = np.zeros((len(texts), self._examples), dtype=np.float32)
        for row, text in zip(likeness, texts, strict=True):
            for group, value in self._vector(Counter(g for g in _groups(text) if g in self._found)).items():
                examples, shares = self._found[group]
                row[examples] += np.float32(value) * shares
        return likeness

    def _vector(self, groups: Counter[str]) -> dict[str, float]:
        weighted = {group: count * self._rarity[group] for group, count in groups.items()}
        length = math.hypot(*weighted.values())
        return {group: value / length for group, value in weighted.items()}


def _groups(text: str) -> list[str]:
    text = f" {text} "
    return [text[i : i + size] for size in (3, 4) for i in range(len(text) - size + 1)]
