"""The router: from a question about the agent to its topic, by similar example questions."""

from __future__ import annotations

import math
import threading
from collections import Counter
from collections.abc import Collection, Sequence
from dataclasses import dataclass
from functools import cache, lru_cache
from importlib import import_module
from typing import TYPE_CHECKING

from ravestate.language import Encoder
from ravestate.language.bundled import ModelMissing
from ravestate.language.loading import LOADING

from .asking import Asked, about_agent, plain
from .life import Life
from .slips import Slips

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

SHARPNESS = 4.0
"""The slope of the similarity of meaning: the vectors of short questions lie close together."""
SPELLING = 0.1
"""The weight of similar spelling; similar meaning has the weight 1. It tolerates typos."""
COMMON = 0.1
"""The similarity of any two questions; it allows topics of different sizes."""
RIDGE = 0.1
"""The ridge penalty: it limits the weight of a single example."""
LEAST = 0.3
"""A question with a lower score resembles none of the examples."""
UNADDRESSED = 0.9
"""The minimum similarity (cosine) of a question without *you* to an example without it: *how is it going*."""
OTHERS = ""


@dataclass(frozen=True, slots=True)
class Match:
    """A question that belongs to a topic."""

    topic: str
    question: str
    """The question in the plain form."""
    score: float
    """The score: near 1 for an example, near 0 for a question unlike any of them."""
    example: str
    """The nearest example."""
    margin: float
    """The distance to the next best score."""
    returned: bool = False
    """Whether the user returned the agent's own question: *fine, and you?*"""


@dataclass(frozen=True, slots=True)
class Miss:
    """The reason why an utterance belongs to no topic."""

    reason: str


class Router:
    """A classifier for questions: a topic of the agent, or none.

    It is a kernel ridge regression over the example questions of a life. The kernel adds a Gaussian of the distance in
    meaning (from an `Encoder`) and the cosine of the spelling (groups of three and four letters). It learns in a second or
    two, at the first question. Thread-safe.

    Example:
        ::

            match Router(read_life()).route("Hey, how old r u?"):
                case Match(topic, score=score): ...     # "age", 0.95
                case Miss(reason): ...
    """

    def __init__(self, life: Life, encoder: Encoder | None = None) -> None:
        """Nothing is loaded yet."""
        self.life = life
        self._encoder = encoder or _bundled()
        self._known = {plain(q): topic.name for topic in life.topics.values() for q in topic.questions}
        self._lock = threading.Lock()
        self._learnt: _Learnt | None = None

    def load(self) -> None:
        """Load the model and learn the examples, once.

        Raises:
            PlatformError: The sentence model is missing or broken. The message says what to do.
        """
        if self._learnt is not None:  # no lock is needed just to check
            return
        with self._lock:
            if self._learnt is None:
                try:
                    with LOADING:
                        import_module("numpy")  # all below needs it
                except ImportError as error:
                    raise ModelMissing("agentqa needs numpy: pip install 'ravestate[sentences]'") from error
                pairs = [(plain(q), topic.name) for topic in self.life.topics.values() for q in topic.questions]
                pairs += [(plain(q), OTHERS) for q in self.life.others]
                self._learnt = _learnt(tuple(pairs), self._encoder)

    def route(self, utterance: str, names: Collection[str] = (), *, question: bool = False) -> Match | Miss:
        """Return the topic that an utterance asks about; the first sentence with one counts.

        Without the package of sentence models, only the examples themselves are understood.

        Args:
            utterance: The user's words.
            names: Further names of the agent.
            question: Whether the utterance is known to ask something.

        Raises:
            PlatformError: The sentence model is broken.
        """
        candidates, why = about_agent(utterance, (self.life.name, *names), self._known, question=question)
        if not candidates:
            return Miss(why)
        try:
            self.load()
        except ModelMissing as error:
            return self._verbatim(candidates) or Miss(str(error))
        assert self._learnt is not None  # `load` has set it
        return self._learnt.best(candidates)

    def _verbatim(self, candidates: Sequence[Asked]) -> Match | None:
        """Return the first candidate that is an example word for word."""
        for text in (asked.text for asked in candidates):
            if text in self._known:
                return Match(self._known[text], text, 1.0, text, 1.0)
        return None


@lru_cache(maxsize=8)
def router_of(life: Life) -> Router:
    """Return the router of a life; all contexts share it."""
    return Router(life)


@cache
def _bundled() -> Encoder:
    """Return the bundled encoder, one for all routers."""
    return Encoder()


@lru_cache(maxsize=8)
def _learnt(pairs: tuple[tuple[str, str], ...], encoder: Encoder) -> _Learnt:
    """Return the classifier for these examples; lives that differ only in their phrases and facts share it."""
    return _Learnt(pairs, encoder)


class _Learnt:
    """The classifier, after learning."""

    def __init__(self, pairs: Sequence[tuple[str, str]], encoder: Encoder) -> None:
        import numpy as np

        self._encoder = encoder
        self._examples = [text for text, _ in pairs]
        self._slips = Slips({word for text in self._examples for word in text.split()})
        self._classes = [*dict.fromkeys(name for _, name in pairs if name != OTHERS), OTHERS]
        self._of = np.array([self._classes.index(name) for _, name in pairs])
        self._unaddressed = np.array([not _addresses(text) for text in self._examples])
        self._meanings = encoder.encode(self._examples)
        self._spelling = _Spelling(self._examples)
        kernel = self._kernel(self._examples, self._meanings)
        kernel[np.diag_indices_from(kernel)] += RIDGE
        self._weights = np.linalg.solve(kernel, np.eye(len(self._classes))[self._of])

    def best(self, candidates: Sequence[Asked]) -> Match | Miss:
        """Return the first candidate that belongs to a topic, or the reason why none does."""
        import numpy as np

        texts = [self._slips.mended(asked.text) for asked in candidates]
        meanings = self._encoder.encode(texts)
        kernel = self._kernel(texts, meanings)
        scores = kernel @ self._weights
        reasons: list[str] = []
        cosines = meanings @ self._meanings.T
        for number, (text, asked) in enumerate(zip(texts, candidates, strict=True)):
            row, like = scores[number], kernel[number]
            order = np.argsort(-row, kind="stable")
            winner, second = int(order[0]), int(order[1])
            topic = winner if self._classes[winner] != OTHERS else second
            near = self._nearest(like, topic)
            if winner != topic:
                other = self._nearest(like, winner)
                reasons.append(
                    f"{text!r} is nearest to {self._classes[topic]} ({row[topic]:.2f}, {near!r}), but nearer to what "
                    f"is not about me ({row[winner]:.2f}, {other!r})"
                )
            elif row[topic] < LEAST:
                reasons.append(
                    f"{text!r} is nearest to {self._classes[topic]}, but not near ({row[topic]:.2f}, {near!r})"
                )
            elif not asked.addressed and not (
                cosines[number, self._unaddressed & (self._of == topic)].max(initial=0.0) >= UNADDRESSED
            ):
                reasons.append(f"{text!r} is like {self._classes[topic]} ({row[topic]:.2f}), but asks no you")
            else:
                margin = float(row[winner] - row[second])
                return Match(self._classes[topic], text, float(row[topic]), near, margin)
        return Miss("; ".join(reasons))

    def _kernel(self, texts: Sequence[str], meanings: NDArray[np.float32]) -> NDArray[np.float64]:
        """Return the similarity of questions (rows) and examples (columns)."""
        import numpy as np

        kernel = np.exp(SHARPNESS * (meanings.astype(np.float64) @ self._meanings.T - 1))
        kernel += SPELLING * self._spelling.likeness(texts) + COMMON
        return kernel

    def _nearest(self, like: NDArray[np.float64], topic: int) -> str:
        import numpy as np

        return self._examples[int(np.where(self._of == topic, like, -np.inf).argmax())]


def _addresses(text: str) -> bool:
    """Return whether a text has *you*."""
    return not {"you", "your", "yourself"}.isdisjoint(text.split())


class _Spelling:
    """Examples as vectors of their letter groups; rare groups weigh more."""

    def __init__(self, examples: Sequence[str]) -> None:
        import numpy as np

        counted = [Counter(_groups(text)) for text in examples]
        spread = Counter(group for groups in counted for group in groups)
        self._examples = len(examples)
        self._rarity = {group: 1 + math.log(len(examples) / (1 + count)) for group, count in spread.items()}
        # An inverted index: for each group the examples that have it, and its weight in each.
        where: dict[str, list[int]] = {}
        shares: dict[str, list[float]] = {}
        for example, groups in enumerate(counted):
            for group, value in self._vector(groups).items():
                where.setdefault(group, []).append(example)
                shares.setdefault(group, []).append(value)
        self._found = {
            group: (np.array(where[group], dtype=np.int32), np.array(shares[group], dtype=np.float32))
            for group in where
        }

    def likeness(self, texts: Sequence[str]) -> NDArray[np.float32]:
        """Return the cosine of each text (rows) with each example (columns); 0 if no group of a text is known."""
        import numpy as np

        likeness = np.zeros((len(texts), self._examples), dtype=np.float32)
        for row, text in zip(likeness, texts, strict=True):
            for group, value in self._vector(Counter(g for g in _groups(text) if g in self._found)).items():
                examples, shares = self._found[group]
                row[examples] += np.float32(value) * shares
        return likeness

    def _vector(self, groups: Counter[str]) -> dict[str, float]:
        weighted = {group: count * self._rarity[group] for group, count in groups.items()}
        length = math.hypot(*weighted.values())
        return {group: value / length for group, value in weighted.items()}


def _groups(text: str) -> list[str]:
    text = f" {text} "
    return [text[i : i + size] for size in (3, 4) for i in range(len(text) - size + 1)]
