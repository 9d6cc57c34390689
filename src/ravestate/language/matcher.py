"""A small classifier of sentences by meaning and spelling, with a class *none of these*.

It is a kernel ridge regression over example sentences. The kernel is a sum of two similarities: a Gaussian of the
distance in meaning (from an `Encoder`), and the cosine of the spelling (groups of three and four letters). The
shape of a sentence is the persons that it mentions, and whether it asks. If the shapes of two sentences differ, for
example *my* and *your*, both similarities are lower.
"""

from __future__ import annotations

import threading
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from importlib import import_module
from typing import TYPE_CHECKING, Any

from .bundled import ModelMissing
from .cache import cached
from .encoder import Encoder
from .entity import Entity
from .examples import bundled
from .factor import factor
from .heap import note_load
from .loading import LOADING
from .normal import plain
from .recent import keep_latest
from .rows import products
from .shape import likeness, shape
from .spelling import BUCKETS, Spelling

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

SHARPNESS = 4.0
"""The slope of the similarity of meaning. It is steep because the vectors of short sentences lie close together."""
SPELLING = 0.1
"""The weight of similar spelling, which helps with typing errors. Similar meaning has the weight 1."""
SHAPE = 0.6
"""If the shapes of two sentences have nothing in common, their similarity loses this share."""
COMMON = 0.1
"""A constant that is added to the similarity of any two sentences, so that classes may differ in size."""
RIDGE = 0.1
"""The ridge penalty: it limits the weight of a single example."""
DOUBT = 0.2
"""`confusions` lists an example if the other examples put it into a wrong class by more than this margin."""
NONE = ""
REMEMBERED = 256
"""The number of sentences whose classes a matcher keeps, because all skills ask for the same sentences."""


@dataclass(frozen=True, slots=True)
class Match:
    """A sentence that resembles the examples of a class."""

    score: float
    """The confidence, 0 to 1: the share of sentences with this margin that belong to the class."""
    example: str
    """The example that resembles the sentence most."""
    margin: float
    """The class's score in the regression, minus the best score of any other class; about 1 for an example."""
    entities: tuple[Entity, ...] = ()
    """The named entities of the utterance, if the match comes from ``nlp``."""
    name: str = ""
    """The class."""
    text: str = ""
    """The sentence."""


class Matcher:
    """A classifier that puts a sentence into one of several classes, or into none. Thread-safe.

    Until `load` is called, it recognises only sentences that equal an example word for word.

    Example:
        ::

            matcher = Matcher({"hours": ["when do you open", "how late are you open"]}, none=["I like tea"])
            matcher.load()
            matcher.match("At what time does the museum open?")     # Match(0.93, 'when do you open', ..., name='hours')
    """

    def __init__(
        self,
        examples: Mapping[str, Sequence[str]],
        none: Sequence[str] = (),
        *,
        least: float = 0.5,
        shapes: float = SHAPE,
        centre: float | None = None,
        encoder: Encoder | None = None,
    ) -> None:
        """Take the examples; load nothing yet.

        Args:
            examples: Sentences by class.
            none: Sentences that belong to no class.
            least: The confidence below which a sentence belongs to no class.
            shapes: The weight of the shape of a sentence (the persons that it mentions, whether it asks), 0 to 1.
            centre: The margin that has the confidence 0.5. By default, the matcher learns it by matching each example
                against the others. Pass 0 for classes of about three examples, which are too few to learn from.
            encoder: The encoder; by default the shared one.
        """
        pairs = [(whole(text), name) for name, texts in examples.items() for text in texts]
        pairs += [(whole(text), NONE) for text in none]
        self.least = least
        self._shapes, self._centre = shapes, centre
        self.exact = dict(pairs)
        # The encoder knows only words: all emoji look alike to it.
        self._pairs = tuple(pair for pair in self.exact.items() if plain(pair[0]))
        self._encoder = encoder or shared_encoder()
        self._lock = threading.Lock()
        self._learnt: _Learnt | None = None
        self._matching = threading.Lock()
        self._latest: dict[str, Match | None] = {}
        self._ranked: dict[str, tuple[Match, ...]] = {}

    @property
    def loaded(self) -> bool:
        """Whether the matcher has learnt the examples."""
        return self._learnt is not None

    def load(self) -> None:
        """Load the encoder and learn the examples, once.

        Raises:
            PlatformError: The sentence model is missing (`ModelMissing`) or broken. The message says how to mend that.
        """
        if self._learnt is not None:  # this check needs no lock
            return
        with self._lock:
            if self._learnt is None:
                try:
                    with LOADING:
                        import_module("numpy")
                except ImportError as error:
                    raise ModelMissing("sentence models need numpy: pip install 'ravestate[sentences]'") from error
                self._learnt = _Learnt(self._pairs, self._encoder, self._shapes, self._centre)
                note_load()

    def confusions(self) -> list[tuple[str, str, str]]:
        """Return the examples that the other examples put into a wrong class: example, its class, the wrong class.

        Raises:
            PlatformError: See `load`.
        """
        self.load()
        assert self._learnt is not None
        return self._learnt.confusions

    def prepare(self, sentences: Sequence[str]) -> None:
        """Encode sentences in one run, so that their vectors are ready when any matcher needs them."""
        if self._learnt is not None:
            self._encoder.encode([plain(sentence) for sentence in sentences])

    def match(self, sentence: str) -> Match | None:
        """Return the class that a sentence belongs to; None if it belongs to no class."""
        return self.match_all([sentence])[0]

    def match_all(self, sentences: Sequence[str]) -> list[Match | None]:
        """Return the class of each sentence; None for a sentence of no class. The encoder runs once for all.

        A sentence that equals an example word for word needs no encoder. A sentence without words belongs to a class only
        if it equals an example.
        """
        if self._learnt is None:
            found = list(map(self.match_exactly, sentences))
        else:
            with self._matching:  # several skills ask for the same sentences at the same time
                known = {sentence: self._latest.get(sentence) or self.match_exactly(sentence) for sentence in sentences}
                new = [sentence for sentence, match in known.items() if match is None and plain(sentence)]
                known.update(zip(new, (ranked[0] for ranked in self.ranked_all(new, most=1)), strict=True))
                keep_latest(self._latest, known, REMEMBERED)
            found = [known[sentence] for sentence in sentences]
        return [best if best and best.name != NONE and best.score >= self.least else None for best in found]

    def match_exactly(self, sentence: str) -> Match | None:
        """Return the class of the example that a sentence equals word for word; None if it equals no example."""
        text = whole(sentence)
        name = self.exact.get(text)
        return None if name is None else Match(1.0, text, 1.0, name=name, text=sentence)

    def ranked(self, sentence: str) -> list[Match]:
        """Return all classes, best first. The class with an empty name is *none of these*."""
        if self._learnt is None:
            return self.ranked_all([sentence])[0]
        with self._matching:
            found = self._ranked.get(sentence) or tuple(self.ranked_all([sentence])[0])
            keep_latest(self._ranked, {sentence: found}, REMEMBERED)
        return list(found)

    def ranked_all(self, sentences: Sequence[str], most: int | None = None) -> list[list[Match]]:
        """Return the `most` best classes of each sentence, best first; by default all."""
        if self._learnt is not None:
            return self._learnt.ranked(sentences, most)
        return [[match] if match else [] for match in map(self.match_exactly, sentences)]


def whole(sentence: str) -> str:
    """Return the form in which a sentence equals an example: its plain form, or itself if it has no words.

    Example:
        >>> whole("How are you?"), whole(" ?! ")
        ('how are you', '?!')
    """
    return plain(sentence) or sentence.strip()


@cache
def shared_encoder() -> Encoder:
    """Return the bundled encoder, which all matchers share."""
    return Encoder()


@cache
def bundled_matcher(name: str) -> Matcher:
    """Return the matcher of a built-in file of examples, such as ``acts`` or ``feelings``. All contexts share it."""
    examples = bundled(name)
    return Matcher(examples.classes, (*examples.none, *bundled("none").none))


class _Learnt:
    """The classifier, after learning."""

    def __init__(self, pairs: Sequence[tuple[str, str]], encoder: Encoder, shapes: float, centre: float | None) -> None:
        import numpy as np

        self._encoder, self._weight = encoder, shapes
        self._examples = [text for text, _ in pairs]
        self._classes = [*dict.fromkeys(name for _, name in pairs if name != NONE), NONE]
        self._of = np.array([self._classes.index(name) for _, name in pairs])
        self._meanings = encoder.encode_lasting(self._examples)
        self._spelling = Spelling(self._examples)
        self._shapes = np.array([shape(text) for text in self._examples], dtype=np.int8)
        key = ["matcher, factored", encoder.identity, pairs, shapes, SHARPNESS, SPELLING, SHAPE, COMMON, RIDGE, BUCKETS]
        learnt = cached(key, self._learn)
        self._weights = np.ascontiguousarray(learnt["weights"].T)  # of shape (classes, examples)
        confused = learnt["confused"].tolist()
        self._slope, self._centre = learnt["curve"].tolist()
        if centre is not None:
            self._centre = centre
        self.confusions: list[tuple[str, str, str]] = [
            (self._examples[number], self._classes[self._of[number]], self._classes[other])
            for number, other in confused
        ]

    def _learn(self) -> dict[str, NDArray[Any]]:
        """Return the weights, the curve from margin to confidence, and the confusions."""
        import numpy as np

        vectors = self._meanings.unpacked()
        kernel = self._kernel(vectors @ vectors.T, self._spelling.among(), self._shapes)
        kernel[np.diag_indices_from(kernel)] += np.float32(RIDGE)
        targets = np.eye(len(self._classes), dtype=np.float32)[self._of]
        factored = factor(kernel)
        weights = factored.T @ (factored @ targets)
        # The scores of each example by a classifier that has learnt all other examples, from the diagonal of the inverse.
        left_out = targets - weights / np.square(factored).sum(axis=0)[:, None]
        margins, others = margins_of(left_out), left_out.argmax(axis=1)
        wrong = np.flatnonzero((others != self._of) & (margins > DOUBT))
        return {
            "weights": weights,
            "curve": np.array(calibrated(margins.astype(np.float64), others == self._of)),
            "confused": np.stack([wrong, others[wrong]], axis=1),
        }

    def ranked(self, sentences: Sequence[str], most: int | None) -> list[list[Match]]:
        """Return the `most` best classes of each sentence, best first; all if `most` is None."""
        import numpy as np

        if not sentences:
            return []
        texts = [plain(sentence) for sentence in sentences]
        shapes = np.array([shape(text) for text in texts], dtype=np.int8)
        meanings = self._meanings.products(self._encoder.encode(texts))
        kernels = self._kernel(meanings, self._spelling.likeness(texts), shapes)
        found: list[list[Match]] = []
        for sentence, kernel, scores in zip(sentences, kernels, products(kernels, self._weights), strict=True):
            order = [int(number) for number in np.argsort(-scores, kind="stable")[:most]]
            found.append([self._match(number, sentence, kernel, scores) for number in order])
        return found

    def _match(self, number: int, sentence: str, kernel: NDArray[np.float32], scores: NDArray[np.float32]) -> Match:
        import numpy as np

        margin = float(scores[number] - np.delete(scores, number).max(initial=-1.0))
        confidence = float(1 / (1 + np.exp(-self._slope * (margin - self._centre))))
        near = self._examples[int(np.where(self._of == number, kernel, -np.inf).argmax())]
        return Match(confidence, near, margin, name=self._classes[number], text=sentence)

    def _kernel(
        self, meanings: NDArray[np.float32], spelling: NDArray[np.float32], shapes: NDArray[np.int8]
    ) -> NDArray[np.float32]:
        """Return the similarity of sentences (rows) and examples (columns), from their cosines, spelling and shapes."""
        import numpy as np

        # In place: for thousands of examples, each copy takes tens of megabytes.
        kernel = (meanings - 1) * SHARPNESS
        np.exp(kernel, out=kernel)
        kernel += SPELLING * spelling
        kernel *= 1 + self._weight * (likeness(shapes, self._shapes) - 1)
        kernel += COMMON
        return kernel


def margins_of(scores: NDArray[Any]) -> NDArray[Any]:
    """Return, for each row, the best score minus the next best."""
    import numpy as np

    two = np.sort(scores, axis=1)[:, -2:]
    return two[:, -1] - two[:, 0]


def calibrated(margins: NDArray[Any], right: NDArray[Any]) -> tuple[float, float]:
    """Return the slope and centre of the logistic curve from margins to shares of right answers (Platt scaling)."""
    import numpy as np

    features: NDArray[Any] = np.stack([margins, np.ones_like(margins)], axis=1)
    hits, misses = int(right.sum()), int((~right).sum())
    target: NDArray[Any] = np.where(right, (hits + 1.0) / (hits + 2.0), 1.0 / (misses + 2.0))
    prior = np.array([6.0, 0.0])
    curve: NDArray[Any] = prior
    for _ in range(30):  # Newton's method, with a weak prior on both parameters
        share = 1 / (1 + np.exp(-np.clip(features @ curve, -30, 30)))
        weighted = features * np.maximum(share * (1 - share), 1e-6)[:, None]
        gradient: NDArray[Any] = features.T @ (share - target) + 0.01 * (curve - prior)
        step: NDArray[Any] = np.linalg.solve(weighted.T @ features + 0.01 * np.eye(2), gradient)
        curve = curve - step
    slope = max(float(curve[0]), 1.0)
    return slope, -float(curve[1]) / slope
