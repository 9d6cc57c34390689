"""What sentences mean, as vectors."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .model import model_in

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

__all__ = ["Encoder"]

BUNDLED = "bge_small_en"


class Encoder:
    """Turns sentences into vectors that lie near each other where the sentences mean alike.

    An encoder costs nothing to make: the model behind it is shared by the whole process, and loaded (0.3 s) when
    it is first asked. It may be asked from any thread.

    Example:
        ::

            mine, yours = Encoder().encode(["What is your name?", "How are you called?"])
            similarity = float(mine @ yours)      # the cosine: the vectors have length 1
    """

    def __init__(self, folder: Path | str | None = None) -> None:
        """Nothing is looked for or loaded yet.

        Args:
            folder: Holds another model: ``model.onnx`` and ``tokenizer.json``, as exported for
                sentence-transformers; ``1_Pooling/config.json`` is heeded. None takes the bundled bge-small-en-v1.5
                (English, 384 dimensions).
        """
        self._folder = folder
        self._mean: bool | None = None

    def load(self) -> None:
        """Load the model, if nobody has; `encode` would do it.

        Raises:
            PlatformError: A package or the model is missing or broken. The message says what to do.
        """
        model_in(self._folder, BUNDLED)

    def encode(self, texts: Sequence[str]) -> NDArray[np.float32]:
        """Return a row for each text: shape (n, d), float32, each of length 1.

        About 3 ms for a sentence on one core. What exceeds the model's window (512 tokens) is not seen.

        Raises:
            PlatformError: See `load`.
        """
        import numpy as np

        model = model_in(self._folder, BUNDLED)
        if self._mean is None:
            self._mean = _pools_by_mean(model.folder)
        rows = np.zeros((len(texts), model.width), dtype=np.float32)
        for indices, hidden, mask in model.run(list(texts)):
            rows[indices] = _pooled(hidden, mask, self._mean)
        norms = np.linalg.norm(rows, axis=1, keepdims=True)
        return rows / np.maximum(norms, 1e-12)


def _pooled(hidden: NDArray[Any], mask: NDArray[Any], mean: bool) -> NDArray[Any]:
    """One vector for each text from the vectors of its tokens, shape (n, tokens, d)."""
    if hidden.ndim == 2:  # the model has done it
        return hidden
    if not mean:
        return hidden[:, 0]
    weights = mask[:, :, None].astype(hidden.dtype)
    return (hidden * weights).sum(axis=1) / weights.sum(axis=1)


def _pools_by_mean(folder: Path) -> bool:
    """Whether the model averages over its tokens; otherwise it takes the first one, as bge does."""
    try:
        config = json.loads((folder / "1_Pooling" / "config.json").read_text(encoding="utf-8"))
        return bool(config["pooling_mode_mean_tokens"])
    except (OSError, ValueError, LookupError, TypeError):
        return False
