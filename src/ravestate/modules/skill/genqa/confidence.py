"""The confidence of an answer: a logistic regression, fitted by ``tools/calibrate_genqa.py``.

The reader is the model that scores how well a passage answers a question.
"""

from __future__ import annotations

import math

INTERCEPT, SCORE, COVERED = -5.806, 0.699, 4.481


def confidence(score: float, covered: float) -> float:
    """Return the probability (0 to 1) that a passage answers the question.

    The lead over the next best passage does not count, because the next best passage is often right, too.

    Args:
        score: The reader's score of the passage.
        covered: The share of the question's words in the passage: 0 to 1.
    """
    return 1.0 / (1.0 + math.exp(-(INTERCEPT + SCORE * score + COVERED * covered)))


def in_talk(score: float, own: float) -> float:
    """Return the probability (0 to 1) that a passage answers a follow-up, a question that refers to earlier questions.

    A high score alone is enough, because a follow-up rarely has the document's own words. The factors are twice the
    fitted factors. This lowers the confidence in doubtful answers, because a wrong answer is worse than no answer.

    Args:
        score: The reader's score of the passage.
        own: The share of the follow-up's words in the passage (0 to 1), without names from earlier questions.
    """
    alone = 1.46 * max(score - 6.0, 0.0) * (1.0 - own)
    return 1.0 / (1.0 + math.exp(-(-9.4 + 0.48 * max(score, 0.0) + 7.72 * own + alone)))
