"""The listener knows which replies in its bank suit an utterance, even one from which its weights were not learned."""

from __future__ import annotations

import numpy as np

from quality.suits import evidence
from ravestate.modules.skill.wildtalk.listening.lookup import ALIKE


def test_most_replies_that_the_listener_chooses_suit_the_utterance() -> None:
    found, suits = evidence("suits_kept")
    chosen = np.array([one.probability() for one in found]) >= ALIKE
    print(suits[chosen].mean(), chosen.sum(), suits[chosen].sum() / suits.sum())
    assert suits[chosen].mean() >= 0.68  # if only similarity decided, fewer than half would suit
    assert suits[chosen].sum() / suits.sum() >= 0.3
