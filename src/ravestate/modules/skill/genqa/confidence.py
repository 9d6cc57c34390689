"""How sure an answer is: a logistic regression, fitted by ``tools/calibrate_genqa.py``."""

from __future__ import annotations

import math
from collections.abc import Sequence

__all__ = ["confidence", "features"]

INTERCEPT, SCORE, GAP, COVERED = -7.388, 0.723, 0.022, 5.425

WIDEST = 8.0
"""A gap beyond this says no more."""


def features(score: float, others: Sequence[float], covered: float) -> tuple[float, float, float]:
    """What the probability is computed from.

    Args:
        score: Of the passage, by the reader.
        others: The scores of the other passages that were read.
        covered: How much of the question the passage mentions: 0 to 1.

    Returns:
        The score, its lead over the next best, and the share that is covered.
    """
    gap = score - max(others) if others else WIDEST
    return score, min(max(gap, 0.0), WIDEST), covered


def confidence(score: float, others: Sequence[float], covered: float) -> float:
    """The probability (0 to 1) that the passage answers the question; see `features`."""
    score, gap, covered = features(score, others, covered)
    return 1.0 / (1.0 + math.exp(-(INTERCEPT + SCORE * score + GAP * gap + COVERED * covered)))
