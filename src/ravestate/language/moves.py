"""Choose the move that a good listener makes next: rejoice, console, advise... ``moves.yaml`` lists the moves.

The classifier is a kernel ridge regression, as in `Matcher`, but over whole utterances. The kernel is a constant plus
three similarities: of the whole utterance's meaning, of its last sentence's meaning, and of form (persons, question,
length).
"""

from __future__ import annotations

import threading
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from importlib import import_module
from typing import TYPE_CHECKING, Any

from .cache import cached
from .contractions import word_set
from .encoder import Encoder
from .examples import bundled
from .heap import note_load
from .loading import LOADING
from .matcher import SHARPNESS, calibrated, margins_of, shared_encoder
from .normal import plain
from .rows import products
from .sentences import sentences as sentences_of
from .shape import shape

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

SPREAD, FORM = 0.05, 1.0
"""`SPREAD` says how fast the similarity of form decays with the distance. `FORM` is the weight of this similarity."""
COMMON = 0.1
"""A constant that the kernel adds for any two utterances."""
RIDGE, RIDGE_BORROWED = 0.5, 2.0
"""The ridge penalty of own examples, and the ridge penalty of borrowed examples. Each limits the weight of an example.

Borrowed examples come from other files, and get less weight.
"""
BORROWED = 25
"""The maximum number of examples that are borrowed from one class of another file."""
UNLIKELY = 0.15
"""The penalty for a move that does not suit the form: `TOLD` after a question, `ASKED` after a statement."""
ASKED = ("fact", "self", "opinion", "recall")
"""Moves that answer a question."""
TOLD = ("interest", "accept", "rejoice", "mourn", "greet", "introduce")
"""Moves that answer no question."""
LISTENING = (
    "interest",
    "accept",
    "rejoice",
    "console",
    "mourn",
    "apologise",
    "greet",
    "introduce",
    "farewell",
    "thank",
)
"""Moves of a listener after a statement of the user."""
SURE = 0.7
"""The least confidence at which a move is sure."""

_GROUPS = tuple(
    word_set(words)
    for words in (
        "why", "who what", "how", "when where", "can could", "should", "remember recall", "said told", "you", "your",
        "i", "my", "not don't", "he she him her", "they we", "his her", "it that",
    )
)  # fmt: skip


@dataclass(frozen=True, slots=True)
class Move:
    """The next move of a listener."""

    name: str
    """``interest``, ``accept``, ``rejoice``, ``console``, ``mourn``, ``apologise``, ``explain``, ``fact``, ``self``, ``opinion``,
    ``advice``, ``recall``, ``test``, ``entertain``, ``obey``, ``greet``, ``introduce``, ``farewell`` or ``thank``."""
    score: float
    """The confidence, 0 to 1: of all utterances with this score, the share for which the move is right."""
    second: str = ""
    """The next best move."""

    @property
    def sure(self) -> bool:
        """Whether the move is sure. If it is not, the answer should suit the second move as well."""
        return self.score >= SURE

    @property
    def listens(self) -> bool:
        """Whether the move is sure, and suits a statement. If so, modules should not look for facts."""
        return self.sure and self.name in LISTENING


class Moves:
    """A classifier that maps an utterance to the next move. Thread-safe; before `load`, it returns no moves."""

    def __init__(self, examples: Mapping[str, Sequence[str]], encoder: Encoder | None = None) -> None:
        """Take the examples, in the format of ``moves.yaml``, and read borrowed examples; load no model yet."""
        own = [(text, name, RIDGE) for name, texts in examples.items() if name != "like" for text in texts]
        others = {**bundled("acts").classes, **bundled("feelings").classes}
        for line in examples.get("like", ()):
            name, _, classes = line.partition(":")
            own += [(text, name, RIDGE_BORROWED) for one in classes.split() for text in others[one][:BORROWED]]
        self._examples = own
        self._encoder = encoder or shared_encoder()
        self._lock = threading.Lock()
        self._learnt: _Learnt | None = None

    def load(self) -> None:
        """Load the encoder and learn the examples, once.

        Raises:
            PlatformError: The sentence model is missing or broken. The message says how to mend that.
        """
        with self._lock:
            if self._learnt is None:
                with LOADING:
                    import_module("numpy")
                self._learnt = _Learnt(self._examples, self._encoder)
                note_load()

    def move(self, sentences: Sequence[str], *, asks: bool) -> Move | None:
        """Return the move that answers an utterance; None before `load`, and for an utterance without words.

        Args:
            sentences: The sentences of the utterance, in the normal form.
            asks: Whether the utterance asks something.
        """
        if self._learnt is None or not any(map(plain, sentences)):
            return None
        return self._learnt.move(sentences, TOLD if asks else ASKED)


@cache
def bundled_moves() -> Moves:
    """Return the classifier with the built-in examples, which all contexts share."""
    return Moves(bundled("moves").classes)


class _Learnt:
    """The classifier, after learning."""

    def __init__(self, examples: Sequence[tuple[str, str, float]], encoder: Encoder) -> None:
        import numpy as np

        self._encoder = encoder
        self._classes = [*dict.fromkeys(name for _, name, _ in examples)]
        self._of = np.array([self._classes.index(name) for _, name, _ in examples])
        self._ridge = np.array([ridge for *_, ridge in examples], dtype=np.float32)
        parts = [sentences_of(text) or (text,) for text, *_ in examples]
        self._whole, self._last = (encoder.encode_lasting(texts) for texts in learnt_texts(examples))
        self._forms = np.array([form(part) for part in parts], dtype=np.float32)
        key = ["moves", encoder.identity, list(examples), SHARPNESS, SPREAD, FORM, COMMON]
        learnt = cached(key, self._learn)
        self._weights = np.ascontiguousarray(learnt["weights"].T)  # of shape (classes, examples)
        self._slope, self._centre = learnt["curve"].tolist()

    def _learn(self) -> dict[str, NDArray[Any]]:
        import numpy as np

        whole, last = self._whole.unpacked(), self._last.unpacked()
        kernel = self._kernel(whole @ whole.T, last @ last.T, self._forms)
        kernel[np.diag_indices_from(kernel)] += self._ridge
        inverse = np.linalg.inv(kernel)
        targets = np.eye(len(self._classes), dtype=np.float32)[self._of]
        weights = inverse @ targets
        left_out = (targets - weights / np.diag(inverse)[:, None])[self._ridge == RIDGE]
        right = left_out.argmax(axis=1) == self._of[self._ridge == RIDGE]
        return {"weights": weights, "curve": np.array(calibrated(margins_of(left_out).astype(np.float64), right))}

    def move(self, sentences: Sequence[str], unlikely: Sequence[str]) -> Move:
        import numpy as np

        vectors = self._encoder.encode([plain(text) for text in compared(sentences)])
        forms = np.array([form(sentences)], dtype=np.float32)
        kernel = self._kernel(self._whole.products(vectors[:1]), self._last.products(vectors[1:]), forms)
        scores = products(kernel, self._weights)[0]
        scores[[self._classes.index(name) for name in unlikely if name in self._classes]] -= UNLIKELY
        best, second = (int(number) for number in np.argsort(-scores, kind="stable")[:2])
        margin = float(scores[best] - scores[second])
        confidence = float(1 / (1 + np.exp(-self._slope * (margin - self._centre))))
        return Move(self._classes[best], confidence, self._classes[second])

    def _kernel(
        self, whole: NDArray[np.float32], last: NDArray[np.float32], forms: NDArray[np.float32]
    ) -> NDArray[np.float32]:
        """Return the similarity of utterances (rows) and examples (columns), from two arrays of cosines and the forms."""
        import numpy as np

        squares = (forms**2).sum(axis=1)[:, None] + (self._forms**2).sum(axis=1) - 2 * products(forms, self._forms)
        kernel = np.exp((whole - 1) * SHARPNESS)
        kernel += np.exp((last - 1) * SHARPNESS)
        kernel += FORM * np.exp(-SPREAD * squares) + COMMON
        return kernel


def learnt_texts(examples: Sequence[tuple[str, str, float]]) -> tuple[list[str], list[str]]:
    """Return the texts to encode, in the plain form: all examples, and the last sentence of each."""
    last = [(sentences_of(text) or (text,))[-1] for text, *_ in examples]
    return [plain(text) for text, *_ in examples], [plain(text) for text in last]


def compared(sentences: Sequence[str]) -> tuple[str, str]:
    """Return the two texts to compare with the examples: the whole utterance, and its last sentence."""
    return " ".join(sentences), sentences[-1] if sentences else ""


def form(sentences: Sequence[str]) -> list[float]:
    """Return the features of the form of an utterance, each 0 or 1."""
    text = " ".join(sentences).rstrip()
    words = plain(text).split()
    *mentioned, order = shape(plain(text))
    last = shape(plain(sentences[-1]))[3]
    found = [text.endswith("?"), "?" in text, "!" in text]
    found += [len(words) <= 3, len(words) <= 6, len(words) > 15, len(sentences) > 1, *mentioned]
    found += [order == kind for kind in range(3)] + [last == kind for kind in range(3)]
    found += [not group.isdisjoint(words) for group in _GROUPS]
    return list(map(float, found))
