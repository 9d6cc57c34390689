"""The probability that the replies of an entry of the bank suit an utterance.

Similar words are not enough. Even if the sentences had a similarity of 0.84 or more, fewer than half of the entries had
replies that suited the whole utterance. So a cross-encoder reads the entry's sentences and the utterance together, and a
logistic function weighs its scores. ``tests/quality/suits.py`` learnt the weights from judged replies.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

CONSTANT, MEAN, BEST, MEANING, LENGTH = -3.507, 0.122, 0.12, 6.133, -0.155
"""The weights of a logistic function (log odds). See `Evidence`."""


@dataclass(frozen=True, slots=True)
class Evidence:
    """The features of an entry of the bank and an utterance.

    Attributes:
        scores: The cross-encoder's logits, one for each sentence of the entry.
        meanings: The cosine similarities of these sentences and the whole utterance.
        lengths: The numbers of words of these sentences. A long sentence may match an utterance in words that do not matter.
    """

    scores: Sequence[float]
    meanings: Sequence[float]
    lengths: Sequence[int]

    def features(self) -> tuple[float, float, float, float]:
        """Return the features: mean and greatest score, mean similarity, mean length."""
        size = len(self.scores)
        return sum(self.scores) / size, max(self.scores), sum(self.meanings) / size, sum(self.lengths) / size

    def probability(self) -> float:
        """Return the probability that the replies suit."""
        mean, best, meaning, length = self.features()
        odds = CONSTANT + MEAN * mean + BEST * best + MEANING * meaning + LENGTH * length
        return 1 / (1 + math.exp(-odds))
