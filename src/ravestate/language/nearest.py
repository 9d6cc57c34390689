"""Find the example that a sentence resembles most: by meaning, and by its pronouns (*my* or *your*).

A `Matcher` learns classes of many examples. `Nearest` learns nothing: it compares a sentence with each single example.
"""

from __future__ import annotations

import threading
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from .encoder import Encoder
from .heap import note_load
from .matcher import shared_encoder
from .normal import plain
from .shape import likeness, opens_question, shape

if TYPE_CHECKING:
    from numpy.typing import NDArray

SHAPE = 0.12
"""If the shapes of two sentences have nothing in common, their similarity loses this share."""
ASKING = 0.05
"""The similarity of a question and a statement loses this share."""


@dataclass(frozen=True, slots=True)
class Near:
    """An example that resembles a sentence."""

    score: float
    """The similarity: 1 for equal sentences; about 0.5 for sentences that have nothing in common."""
    place: int
    """The index of the example in the list of examples."""
    text: str
    """The sentence that the example resembles."""


class Nearest:
    """An index of example sentences. Thread-safe. Until `load` is called, it finds only examples word for word."""

    def __init__(self, examples: Sequence[str], encoder: Encoder | None = None, *, searched: int | None = None) -> None:
        """Take the examples; load nothing yet.

        Args:
            examples: The sentences.
            encoder: By default the shared encoder.
            searched: `nearest` searches only this many examples, from the first on; by default all. Only `compared`
                uses the other examples; their vectors do not stay in memory.
        """
        self._examples = [plain(text) for text in examples]
        self._searched = len(examples) if searched is None else searched
        self._exact = {text: place for place, text in reversed([*enumerate(self._examples[: self._searched])])}
        self._encoder = encoder or shared_encoder()
        self._lock = threading.Lock()
        self._learnt: _Learnt | None = None

    def load(self) -> None:
        """Load the encoder and the vectors of the examples, once.

        Raises:
            PlatformError: The sentence model is missing or broken. The message says how to mend that.
        """
        with self._lock:
            if self._learnt is None:
                self._encoder.load()
                self._learnt = _Learnt(self._examples, self._encoder, self._searched)
                note_load()

    @property
    def loaded(self) -> bool:
        """Whether `load` has succeeded."""
        return self._learnt is not None

    def similarities(self, text: str, places: Sequence[int]) -> list[float]:
        """Return a text's cosine similarity to each searched example at `places`. Before `load`, all are 0.0."""
        return [0.0] * len(places) if self._learnt is None else self._learnt.similarities(plain(text), places)

    def compared(self, sentences: Sequence[str], places: Sequence[int]) -> list[float]:
        """Return the scores (`Near.score`) of the examples at `places`, each for the sentence most similar to it."""
        texts = {plain(sentence): sentence for sentence in sentences}
        if self._learnt is None:
            return [float(self._examples[place] in texts) for place in places]
        return self._learnt.compared(texts, places) if texts and places else [0.0] * len(places)

    def nearest(self, sentences: Sequence[str], most: int = 5) -> list[Near]:
        """Return up to `most` examples that resemble one of the sentences; the most similar example comes first."""
        texts = {plain(sentence): sentence for sentence in sentences}
        if self._learnt is None:
            return [Near(1.0, self._exact[text], texts[text]) for text in texts if text in self._exact][:most]
        return self._learnt.nearest(texts, most) if texts else []


class _Learnt:
    """The vectors and shapes of the examples."""

    def __init__(self, examples: Sequence[str], encoder: Encoder, searched: int) -> None:
        self._encoder = encoder
        self._examples = examples
        self._known = _Group(examples[:searched], encoder)

    def similarities(self, text: str, places: Sequence[int]) -> list[float]:
        """Return the cosine similarities of a plain text to searched examples."""
        return self._known.meanings.some(places).products(self._encoder.encode([text]))[0].tolist()

    def compared(self, texts: dict[str, str], places: Sequence[int]) -> list[float]:
        """Return the scores of some examples, each for the text most similar to it."""
        group = _Group([self._examples[place] for place in places], self._encoder)
        return group.scores(texts).max(axis=0).tolist()

    def nearest(self, texts: dict[str, str], most: int) -> list[Near]:
        """Return the examples nearest to the texts, each with the written sentence that it resembles."""
        import numpy as np

        found: list[Near] = []
        for text, row in zip(texts.values(), self._known.scores(texts), strict=True):
            least = np.partition(row, -most)[-most] if len(row) > most else -np.inf
            best = np.flatnonzero(row >= least)
            order = best[np.argsort(-row[best], kind="stable")][:most]
            found += [Near(float(row[place]), int(place), text) for place in order]
        return sorted(found, key=lambda near: -near.score)[:most]


class _Group:
    """The vectors and shapes of some examples."""

    def __init__(self, examples: Sequence[str], encoder: Encoder) -> None:
        import numpy as np

        self._encoder = encoder
        self.meanings = encoder.encode_lasting(examples)
        self._shapes = np.array([shape(text) for text in examples], dtype=np.int8).reshape(-1, 4)
        self._asks = np.array([opens_question(text) for text in examples], dtype=np.bool_)

    def scores(self, texts: dict[str, str]) -> NDArray[Any]:
        """Return the score of each example (column) for each text (row). `texts` maps plain texts to written sentences."""
        import numpy as np

        plains = list(texts)
        shapes = np.array([shape(text) for text in plains], dtype=np.int8)
        scores: NDArray[Any] = self.meanings.products(self._encoder.encode(plains))
        scores *= 1 + SHAPE * (likeness(shapes, self._shapes) - 1)
        asks = np.array([texts[text].rstrip().endswith("?") or opens_question(text) for text in plains])
        scores *= 1 - ASKING * (asks[:, None] != self._asks[None, :])
        return scores
