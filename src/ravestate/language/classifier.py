"""Put a text into one of several classes."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path

from .network import Network

REMEMBERED = 256
"""The number of texts whose classes a classifier keeps, because modules may ask for a text again."""
RANKED = 5
"""The maximum number of classes that `Classifier.ranked` returns."""
LONGEST = 300
"""The maximum number of characters that a classifier reads."""


class Classifier(Network):
    """A small recurrent network that reads the first `LONGEST` characters of a text. Thread-safe.

    `Matcher` learns from a few examples when the program starts. A classifier needs thousands of examples and a
    training beforehand, and is more often right than a matcher.

    Example:
        ::

            classifier = Classifier(file)
            classifier.load()
            classifier.best("You bet.")     # ("yes 2", 0.98)
    """

    def __init__(self, file: Path) -> None:
        """Choose a trained network; load nothing yet."""
        super().__init__(file)
        self._latest = lru_cache(REMEMBERED)(self._ranked)

    def best(self, text: str) -> tuple[str, float]:
        """Return the likeliest class of a text in normal form, and its probability; an empty class before `load`.

        A text takes about 4 ms on one core.
        """
        return next(iter(self.ranked(text)), ("", 0.0))

    def ranked(self, text: str, before: str = "") -> tuple[tuple[str, float], ...]:
        """Return the likeliest classes of a text with their probabilities; none before `load`, or for a blank text.

        Args:
            text: A text in normal form.
            before: The user's previous utterance, if the network reads it.
        """
        text, before = text[:LONGEST], before[:LONGEST]  # long texts would fill the cache
        return self._latest(text, before) if self.loaded and text.strip() else ()

    def _ranked(self, text: str, before: str) -> tuple[tuple[str, float], ...]:
        _, (chances,) = self.run(text, before=before)
        order: list[int] = (-chances[0]).argsort(kind="stable")[:RANKED].tolist()
        return tuple((self.labels[place], float(chances[0][place])) for place in order)
