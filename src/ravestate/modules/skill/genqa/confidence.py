"""How sure an answer is: a logistic regression, fitted by ``tools/calibrate_genqa.py``."""

from __future__ import annotations

import math

__all__ = ["confidence"]

INTERCEPT, SCORE, COVERED = -6.419, 0.634, 5.337


def confidence(score: float, covered: float) -> float:
    """The probability (0 to 1) that a passage answers the question.

    The lead over the next best passage was tried as well and tells nothing more: the next best is often right, too.

    Args:
        score: Of the passage, by the reader.
        covered: How much of the question the passage mentions: 0 to 1.
    """
    return 1.0 / (1.0 + math.exp(-(INTERCEPT + SCORE * score + COVERED * covered)))
