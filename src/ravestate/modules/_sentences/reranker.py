"""How well passages answer a question."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from .model import model_in

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

__all__ = ["Reranker"]

BUNDLED = "reranker_en"


class Reranker:
    """Reads a question together with each passage and says how well the passage answers it (a cross-encoder).

    Like an `Encoder` it costs nothing to make, is shared by the process, loaded when first asked, and may be asked
    from any thread.

    Example:
        ::

            scores = Reranker().score("Why is the sky blue?", ["Blue light is scattered most.", "I like blue."])
            best = int(scores.argmax())
    """

    def __init__(self, folder: Path | str | None = None) -> None:
        """Nothing is looked for or loaded yet.

        Args:
            folder: Holds another cross-encoder with one output: ``model.onnx`` and ``tokenizer.json``. None takes
                the bundled ms-marco-MiniLM-L-12-v2 (English).
        """
        self._folder = folder

    def load(self) -> None:
        """Load the model, if nobody has; `score` would do it.

        Raises:
            PlatformError: A package or the model is missing or broken. The message says what to do.
        """
        model_in(self._folder, BUNDLED)

    def score(self, query: str, passages: Sequence[str]) -> NDArray[np.float32]:
        """Return a score for each passage: shape (n,), float32, higher is better.

        Scores are logits: for the bundled model about -11 (has nothing to do with it) to +11 (answers it). About
        3 ms for a pair of short sentences. What exceeds the model's window (512 tokens for both) is not seen.

        Raises:
            PlatformError: See `load`.
        """
        import numpy as np

        model = model_in(self._folder, BUNDLED)
        scores = np.zeros(len(passages), dtype=np.float32)
        for indices, logits, _ in model.run([(query, passage) for passage in passages]):
            scores[indices] = logits.reshape(len(indices), -1)[:, 0]
        return scores
