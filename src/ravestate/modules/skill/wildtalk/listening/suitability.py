"""The probability that the replies of an entry of the bank suit an utterance.

Similarity is not enough. Even among entries with a similarity of 0.84 or more, fewer than half had replies that suited
the whole utterance. So a cross-encoder reads each of the entry's sentences together with the utterance. A logistic
function combines its scores with the similarities. ``tests/quality/suits.py`` fits the weights to judged replies.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

WEIGHTS = -9.199, 4.768, 2.046, 5.046, 0.061, 0.081
"""The constant and the weights of the logistic function, in the order of `Evidence.features`."""
ROUGH = -13.27, 7.772, 2.13, 6.346
"""The constant and the weights if there are no scores of the cross-encoder."""


@dataclass(frozen=True, slots=True)
class Evidence:
    """The features of an entry of the bank, compared with an utterance.

    Without the cross-encoder's scores, the estimate is rougher, but takes only a few milliseconds.

    Attributes:
        near: The greatest similarity between a sentence of the entry and a sentence of the utterance, as `Nearest`
            computes it: by meaning and by the persons mentioned.
        meanings: The cosine similarity of each sentence of the entry to the whole utterance.
        scores: The cross-encoder's logits, one for each sentence of the entry; empty if the cross-encoder was not used.
    """

    near: float
    meanings: Sequence[float]
    scores: Sequence[float] = ()

    def features(self) -> tuple[float, ...]:
        """Return `near`, the second greatest and the mean of `meanings`, and the greatest and the mean of `scores`, if any.

        One sentence may be similar by chance. If two are similar, the utterance probably belongs to the entry.
        """
        size = len(self.meanings)
        rough = self.near, sorted(self.meanings)[-2:][0], sum(self.meanings) / size
        return (*rough, max(self.scores), sum(self.scores) / size) if self.scores else rough

    def probability(self) -> float:
        """Return the probability that the replies suit."""
        constant, *weights = WEIGHTS if self.scores else ROUGH
        odds = constant + sum(weight * feature for weight, feature in zip(weights, self.features(), strict=True))
        return 1 / (1 + math.exp(-odds))
