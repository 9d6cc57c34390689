"""Spontaneous feelings: certain words of the user, such as a greeting, raise them at random."""

from __future__ import annotations

import random
from collections.abc import Mapping, Sequence

from ravestate.language.acts import acts
from ravestate.language.normal import plain
from ravestate.language.shape import shape

from .feeling import Feeling

OCCASIONS: tuple[Feeling, ...] = ("affectionate", "happy", "shy", "surprised")


def by_chance(sentences: Sequence[str], likely: Mapping[Feeling, float], rng: random.Random) -> Feeling | None:
    """Return a spontaneous feeling in response to the sentences of an utterance, or None.

    Args:
        sentences: The user's sentences, corrected (in the normal form of `ravestate.language.normal`).
        likely: The probability of each feeling on its occasion. The occasions are, in this order: a goodbye, a greeting
            or thanks, words about the agent, a question. If there are several, only the first of this list counts.
        rng: The random number generator.

    Example:
        >>> by_chance(["What are you up to today?"], {"shy": 1.0}, random.Random(0))
        'shy'
    """
    heard = acts(sentences)
    shapes = [shape(plain(sentence)) for sentence in sentences]
    occasions: dict[Feeling, bool] = {
        "affectionate": "farewell" in heard,
        "happy": "greeting" in heard or "thanks" in heard,
        "shy": any(agent for agent, _, _, _ in shapes),
        "surprised": any(order for _, _, _, order in shapes) or any("?" in sentence for sentence in sentences),
    }
    for feeling, occurs in occasions.items():
        if occurs:
            return feeling if rng.random() < likely.get(feeling, 0.0) else None
    return None
