"""Put a text into one of several classes."""

from __future__ import annotations

from .head import Head
from .network import LONGEST


class Classifier(Head):
    """A head of the network that puts the first `LONGEST` characters of a text into a class. Thread-safe.

    `Matcher` learns from a few examples when the program starts. A classifier needs thousands of examples and a
    training beforehand, and is more often right than a matcher.

    Example:
        ::

            classifier = Classifier("answers")
            classifier.load()
            classifier.best("You bet.")     # ("yes 2", 0.98)
    """

    def best(self, text: str) -> tuple[str, float]:
        """Return the likeliest class of a text in normal form, and its probability; an empty class before `load`.

        A text takes about 8 ms on one core, or no time if the network has just read it for another head.
        """
        return next(iter(self.ranked(text)), ("", 0.0))

    def ranked(self, text: str) -> list[tuple[str, float]]:
        """Return the classes of a text in normal form with their probabilities, the likeliest first.

        The result is empty before `load`, or for a blank text.
        """
        outputs = self._network.read(text[:LONGEST])
        if not outputs:
            return []
        chances = outputs[self._name]
        order: list[int] = (-chances).argsort(kind="stable").tolist()
        return [(self.labels[place], float(chances[place])) for place in order]
