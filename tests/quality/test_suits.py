"""The listener knows which replies of its bank suit, on utterances from which its judgement was not learnt."""

from __future__ import annotations

import numpy as np

from quality.suits import evidence
from ravestate.modules.skill.wildtalk.listening.hearing import ALIKE, SIMILAR


def test_most_replies_that_it_chooses_suit() -> None:
    found, suits = evidence("suits_kept")
    fits = np.array([one.probability() for one in found])
    shares = {least: suits[fits >= least].mean() for least in (SIMILAR, ALIKE)}
    print(shares, (fits >= SIMILAR).sum(), suits[fits >= SIMILAR].sum() / suits.sum())
    assert shares[SIMILAR] >= 0.65  # of the entries whose sentences are as similar, less than half do
    assert shares[ALIKE] >= 0.7
    assert suits[fits >= SIMILAR].sum() / suits.sum() >= 0.55
