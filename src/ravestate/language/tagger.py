"""Find the words in a text that are values: a name, a town, a job."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING

from .network import Network

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

REMEMBERED = 64
"""The number of texts whose tags a tagger keeps, because a skill asks for the same text several times."""


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


class Tagger(Network):
    """A small recurrent network that labels the words of a text, on top of the bundled sentence model. Thread-safe.

    For each token, the network says whether a value begins there, goes on there, or neither (the BIO scheme). It also says
    whether the text denies the value. ``tools/networks`` trains it on marked sentences. The trained file is in the folder
    of the module that uses it.

    Example:
        ::

            tagger = Tagger(file)
            tagger.load()
            tagger.tags("I grew up near Leeds, not in Rome.")   # (Tag("childhood", "Leeds", ...), ...)
    """

    def __init__(self, file: Path) -> None:
        """Choose a trained network; load nothing yet."""
        super().__init__(file)
        self._latest = lru_cache(REMEMBERED)(self._tags)

    def tags(self, text: str, context: str = "") -> tuple[Tag, ...]:
        """Return the tags of a text in their order; nothing before `load`.

        A text takes about 4 ms on one core.

        Args:
            text: One or more sentences in normal form.
            context: The label of the value that the agent has just asked for, so that a fragment may be the answer.
        """
        return self._latest(text, context) if self.loaded and text.strip() else ()

    def _tags(self, text: str, context: str) -> tuple[Tag, ...]:
        asked = self.labels.index(context) + 1 if context in self.labels else 0
        spans, (chances, denials) = self.run(text, asked)
        return tuple(self._decoded(text, spans, chances[0], denials[0]))

    def _decoded(
        self, text: str, spans: list[tuple[int, int]], chances: NDArray[np.float32], denials: NDArray[np.float32]
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
                    found.append(Tag(self.labels[label], text[start:end], start, end, denied, score))
            at = after
        return found


def _joins(letter: str) -> bool:
    """Return whether a character stands inside a word: *Stow-on-the-Wold*."""
    return letter.isalnum() or letter == "-"
