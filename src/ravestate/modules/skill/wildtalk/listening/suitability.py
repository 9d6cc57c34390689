"""The probability that the replies of an entry of the bank suit an utterance.

Similar words are not enough. Even if the sentences had a similarity of 0.84 or more, fewer than half of the entries had
replies that suited the whole utterance. So a cross-encoder reads the entry's sentences and the utterance together, and a
logistic function weighs its scores. ``tests/quality/suits.py`` learnt the weights from judged replies.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

CONSTANT, NEAR, SECOND, MEANING, BEST, MEAN = -9.199, 4.768, 2.046, 5.046, 0.061, 0.081
"""The weights of a logistic function (log odds), in the order of `Evidence.features`."""


@dataclass(frozen=True, slots=True)
class Evidence:
    """The features of an entry of the bank and an utterance.

    Attributes:
        near: The similarity of the nearest sentences, as `Nearest` gives it: by meaning and by the persons mentioned.
        meanings: The cosine similarities of the entry's sentences and the whole utterance.
        scores: The cross-encoder's logits, one for each sentence of the entry.
    """

    near: float
    meanings: Sequence[float]
    scores: Sequence[float]

    def features(self) -> tuple[float, float, float, float, float]:
        """Return nearness, second greatest and mean similarity, greatest and mean score.

        One sentence may be near by chance. If two are near, the utterance belongs to the entry.
        """
        size = len(self.scores)
        second = sorted(self.meanings)[-2:][0]
        return self.near, second, sum(self.meanings) / size, max(self.scores), sum(self.scores) / size

    def probability(self) -> float:
        """Return the probability that the replies suit."""
        weights = NEAR, SECOND, MEANING, BEST, MEAN
        odds = CONSTANT + sum(weight * feature for weight, feature in zip(weights, self.features(), strict=True))
        return 1 / (1 + math.exp(-odds))
