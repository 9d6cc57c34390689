"""Find the words in a text that are values: a name, a town, a job."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from .head import Head
from .network import Network

if TYPE_CHECKING:
    from collections.abc import Sequence

    import numpy as np
    from numpy.typing import NDArray

FACTS, DENIALS = "facts", "denials"
"""The outputs of the network: the chance of each class for each token, and the chance that a token is denied."""


@dataclass(frozen=True, slots=True)
class Tag:
    """Words of a text, and the label that they have."""

    label: str
    text: str
    start: int
    """The position of the first character in the text."""
    end: int
    """The position after the last character."""
    negated: bool
    """Whether the text denies the value, or says that it is no longer true."""
    score: float
    """The confidence, 0 to 1: the mean over the tokens."""


class Tagger(Head):
    """The head of the network that labels the words of a text. Thread-safe.

    For each token, the network says whether a value begins there, goes on there, or neither (the BIO scheme). It also says
    whether the text denies the value. ``tools/networks`` trains it on marked sentences.

    Example:
        ::

            tagger = Tagger()
            tagger.load()
            tagger.tags("I grew up near Leeds, not in Rome.")   # (Tag("childhood", "Leeds", ...), ...)
    """

    def __init__(self, source: Network | None = None) -> None:
        """Choose the network (by default, the bundled network); load nothing yet."""
        super().__init__(FACTS, source)

    def tags(self, text: str, context: str = "") -> list[Tag]:
        """Return the tags of a text in their order; nothing before `load`.

        Args:
            text: One or more sentences in normal form.
            context: The label of the value that the agent has just asked for, so that a fragment may be the answer.
        """
        if not self.loaded:
            return []
        labels = self.labels
        outputs = self._network.read(text, asked=labels.index(context) + 1 if context in labels else 0)
        if not outputs:
            return []
        return _decoded(text, labels, outputs["spans"].tolist(), outputs[FACTS], outputs[DENIALS])


def _decoded(
    text: str,
    labels: Sequence[str],
    spans: Sequence[Sequence[int]],
    chances: NDArray[np.float32],
    denials: NDArray[np.float32],
) -> list[Tag]:
    """Return the runs of tokens that have a label, each widened to whole words.

    Args:
        text: The text.
        spans: The span of each token.
        chances: The chance of each class: shape (tokens, 1 + 2 * labels). Class 0 is *no value*. A label has two
            classes, for its first token and for the others.
        denials: The chance that the text denies the value: shape (tokens,).
    """
    best = chances.argmax(axis=1).tolist()
    best = [one if start < end else 0 for one, (start, end) in zip(best, spans, strict=True)]
    found: list[Tag] = []
    at = 0
    while at < len(best):
        after = at + 1
        if best[at]:
            label = (best[at] - 1) // 2
            while after < len(best) and (
                best[after] == 2 * label + 2
                or (best[after] == 2 * label + 1 and not text[spans[after - 1][1] : spans[after][0]].strip(" -'’"))
            ):  # without a comma or "and" between them, two beginnings are one value
                after += 1
            start, end = spans[at][0], spans[after - 1][1]
            after_last = found[-1].end if found else 0
            while start > after_last and _joins(text[start - 1]):
                start -= 1
            while end < len(text) and _joins(text[end]):
                end += 1
            score = float(chances[at:after, 2 * label + 1 : 2 * label + 3].sum(axis=1).mean())
            denied = float(denials[at:after].mean()) > 0.5
            if start >= after_last:
                found.append(Tag(labels[label], text[start:end], start, end, denied, score))
        at = after
    return found


_TAGGER = Tagger()


def tagger() -> Tagger:
    """Return the tagger of the bundled network, which all contexts share. It may not be loaded yet."""
    return _TAGGER


def _joins(letter: str) -> bool:
    """Return whether a character stands inside a word: *Stow-on-the-Wold*."""
    return letter.isalnum() or letter == "-"
