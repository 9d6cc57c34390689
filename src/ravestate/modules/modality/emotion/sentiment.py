"""How positive a text is, by VADER: a lexicon of valences, with rules for negation and emphasis."""

from __future__ import annotations

from functools import lru_cache
from importlib import import_module
from typing import Any

from ravestate.errors import PlatformError
from ravestate.language.loading import LOADING


def polarity(text: str) -> float:
    """Return how positive `text` is, from -1 to 1.

    Raises:
        PlatformError: vaderSentiment is not installed.
    """
    return float(_analyser().polarity_scores(text)["compound"])


def valence(word: str) -> float:
    """Return how positive `word` is by itself, from -4 to 4; 0 if it is neutral or unknown.

    Raises:
        PlatformError: vaderSentiment is not installed.
    """
    return float(_analyser().lexicon.get(word, 0.0))


@lru_cache(maxsize=1)
def _analyser() -> Any:
    """Read the lexicon: about 30 ms, once per process."""
    try:
        with LOADING:
            vader = import_module("vaderSentiment.vaderSentiment")  # it has no types
    except ImportError as error:
        raise PlatformError("emotion needs vaderSentiment: pip install 'ravestate[emotion]'") from error
    return vader.SentimentIntensityAnalyzer()
