"""Put a text into one of several classes."""

from __future__ import annotations

from .network import LONGEST, Network, network


class Classifier:
    """A head of the network that puts the first `LONGEST` characters of a text into a class. Thread-safe.

    `Matcher` learns from a few examples when the program starts. A classifier needs thousands of examples and a
    training beforehand, and is more often right than a matcher.

    Example:
        ::

            classifier = Classifier("answers")
            classifier.load()
            classifier.best("You bet.")     # ("yes 2", 0.98)
    """

    def __init__(self, head: str, source: Network | None = None) -> None:
        """Choose a head of the network; load nothing yet.

        Args:
            head: The head's name.
            source: The network; by default, the bundled network.
        """
        self._head = head
        self._network = source or network()

    @property
    def loaded(self) -> bool:
        """Whether the network is ready."""
        return self._network.loaded

    def load(self) -> None:
        """Load the network, once. This raises the same errors as `Network.load`."""
        self._network.load()

    @property
    def labels(self) -> list[str]:
        """The classes; none before `load`."""
        return self._network.labels(self._head)

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
        chances = outputs[self._head]
        order: list[int] = (-chances).argsort(kind="stable").tolist()
        return [(self.labels[place], float(chances[place])) for place in order]
