"""The probability that the replies of an entry of the bank suit an utterance.

Similar words are not enough. Even if the sentences had a similarity of 0.84 or more, fewer than half of the entries had
replies that suited the whole utterance. So a cross-encoder reads the entry's sentences and the utterance together, and a
logistic function weighs its scores. ``tests/quality/suits.py`` learnt the weights from judged replies.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

WEIGHTS = -9.199, 4.768, 2.046, 5.046, 0.061, 0.081
"""The constant and the weights of a logistic function (log odds), in the order of `Evidence.features`."""
ROUGH = -13.27, 7.772, 2.13, 6.346
"""The same without the scores of the cross-encoder."""


@dataclass(frozen=True, slots=True)
class Evidence:
    """The features of an entry of the bank and an utterance.

    Without the cross-encoder's scores, the estimate is rougher, but takes a few milliseconds instead of a tenth of a second.

    Attributes:
        near: The similarity of the nearest sentences, as `Nearest` gives it: by meaning and by the persons mentioned.
        meanings: The cosine similarities of the entry's sentences and the whole utterance.
        scores: The cross-encoder's logits, one for each sentence of the entry; empty if it was not asked.
    """

    near: float
    meanings: Sequence[float]
    scores: Sequence[float] = ()

    def features(self) -> tuple[float, ...]:
        """Return nearness, second greatest and mean similarity, and, with scores, the greatest and the mean score.

        One sentence may be near by chance. If two are near, the utterance belongs to the entry.
        """
        size = len(self.meanings)
        rough = self.near, sorted(self.meanings)[-2:][0], sum(self.meanings) / size
        return (*rough, max(self.scores), sum(self.scores) / size) if self.scores else rough

    def probability(self) -> float:
        """Return the probability that the replies suit."""
        constant, *weights = WEIGHTS if self.scores else ROUGH
        odds = constant + sum(weight * feature for weight, feature in zip(weights, self.features(), strict=True))
        return 1 / (1 + math.exp(-odds))
