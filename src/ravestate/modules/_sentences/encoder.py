"""The meanings of sentences as vectors."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .model import model_in

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

BUNDLED = "bge_small_en"


class Encoder:
    """An encoder of sentences: similar meanings give similar vectors.

    Making an encoder is free: the process shares its model, which the first use loads (0.3 s). Any thread may use it.

    Example:
        ::

            mine, yours = Encoder().encode(["What is your name?", "How are you called?"])
            similarity = float(mine @ yours)      # the cosine: the vectors have length 1
    """

    def __init__(self, folder: Path | str | None = None) -> None:
        """Choose a model; the first use finds and loads it.

        Args:
            folder: The folder of a model for sentence-transformers: ``model.onnx``, ``tokenizer.json``, and
                ``1_Pooling/config.json`` if there is one. None: the bundled bge-small-en-v1.5 (English, 384 dimensions).
        """
        self._folder = folder
        self._mean: bool | None = None

    def load(self) -> None:
        """Load the model now; otherwise the first `encode` does.

        Raises:
            PlatformError: A package or the model is missing or broken. The message says what to do.
        """
        model_in(self._folder, BUNDLED)

    def encode(self, texts: Sequence[str]) -> NDArray[np.float32]:
        """Return a row for each text: shape (n, d), float32, each of length 1.

        A sentence takes about 3 ms on one core. The model reads the first 512 tokens of a text.

        Raises:
            PlatformError: See `load`.
        """
        model = model_in(self._folder, BUNDLED)  # first: it says what to install
        import numpy as np

        if self._mean is None:
            self._mean = _pools_by_mean(model.folder)
        rows = np.zeros((len(texts), model.width), dtype=np.float32)
        for indices, hidden, mask in model.run(list(texts)):
            rows[indices] = _pooled(hidden, mask, self._mean)
        norms = np.linalg.norm(rows, axis=1, keepdims=True)
        return rows / np.maximum(norms, 1e-12)


def _pooled(hidden: NDArray[Any], mask: NDArray[Any], mean: bool) -> NDArray[Any]:
    """Return one vector for each text, from its tokens' vectors of shape (n, tokens, d)."""
    if hidden.ndim == 2:  # the model has pooled them
        return hidden
    if not mean:
        return hidden[:, 0]
    weights = mask[:, :, None].astype(hidden.dtype)
    return (hidden * weights).sum(axis=1) / weights.sum(axis=1)


def _pools_by_mean(folder: Path) -> bool:
    """Return whether the model averages over its tokens. Otherwise it takes the first, as bge does."""
    try:
        config = json.loads((folder / "1_Pooling" / "config.json").read_text(encoding="utf-8"))
        return bool(config["pooling_mode_mean_tokens"])
    except (OSError, ValueError, LookupError, TypeError):
        return False
