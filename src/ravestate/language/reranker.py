"""Score passages as answers to a question."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from .model import model_in

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

BUNDLED = "reranker_en"


class Reranker:
    """A cross-encoder: it scores how well a passage answers a question.

    Making a reranker takes no time. Its first use loads the shared model, and raises the same errors as `Encoder`.
    Thread-safe.

    Example:
        ::

            scores = Reranker().score("Why is the sky blue?", ["Blue light is scattered most.", "I like blue."])
            best = int(scores.argmax())
    """

    def __init__(self, folder: Path | str | None = None) -> None:
        """Choose a model; the first use finds and loads it.

        Args:
            folder: The folder of a cross-encoder with one output: ``model.onnx`` and ``tokenizer.json``. None: the
                bundled ms-marco-MiniLM-L-12-v2 (English).
        """
        self._folder = folder

    def load(self) -> None:
        """Load the model now, not at the first `score`."""
        model_in(self._folder, BUNDLED)

    def score(self, query: str, passages: Sequence[str]) -> NDArray[np.float32]:
        """Return a score for each passage: shape (n,), float32, higher is better.

        Scores are logits. The bundled model's scores go from about -11 (unrelated) to +11 (an answer). A pair of short
        sentences takes about 3 ms. The model reads at most 512 tokens of a pair.
        """
        return self.score_pairs([(query, passage) for passage in passages])

    def score_pairs(self, pairs: Sequence[tuple[str, str]]) -> NDArray[np.float32]:
        """Return a score for each pair of a query and a passage: shape (n,), float32, as `score` does."""
        # Load the model before numpy is imported: the model's error says what to install.
        model = model_in(self._folder, BUNDLED)
        import numpy as np

        scores = np.zeros(len(pairs), dtype=np.float32)
        for indices, logits, _ in model.run(pairs):
            scores[indices] = logits.reshape(len(indices), -1)[:, 0]
        return scores
