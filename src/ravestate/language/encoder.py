"""Turn sentences into vectors that stand for their meanings."""

from __future__ import annotations

import json
import threading
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .cache import cached
from .model import SentenceModel, model_in
from .recent import keep_latest
from .rows import Rows
from .vectors import built_in

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

BUNDLED = "bge_small_en"
REMEMBERED = 1024
"""The number of vectors that an encoder keeps, because all skills ask for the same sentences."""


class Encoder:
    """Turns sentences into vectors. Similar meanings give similar vectors.

    Making an encoder takes no time. Its first use loads the shared model (0.3 s). Thread-safe.

    Example:
        ::

            mine, yours = Encoder().encode(["What is your name?", "What are you called?"])
            similarity = float(mine @ yours)      # the cosine: the vectors have length 1
    """

    def __init__(self, folder: Path | str | None = None) -> None:
        """Choose a model; the first use finds and loads it.

        Args:
            folder: The folder of a model for sentence-transformers: ``model.onnx``, ``tokenizer.json``, and
                perhaps ``1_Pooling/config.json``. None: the bundled bge-small-en-v1.5 (English, 384 dimensions).
        """
        self._folder = folder
        self._model: SentenceModel | None = None
        self._mean: bool | None = None
        self._lock = threading.Lock()
        self._latest: dict[str, NDArray[np.float32]] = {}
        self._running: dict[str, threading.Event] = {}

    def load(self) -> None:
        """Load the model now. Otherwise, the first use of another method loads it, and raises the same errors.

        Raises:
            PlatformError: A package or the model is missing or broken. The message says how to mend that.
        """
        self._loaded()

    def encode(self, texts: Sequence[str]) -> NDArray[np.float32]:
        """Return one vector of length 1 for each text, as the rows of an array: shape (n, d), float32.

        A new sentence takes about 3 ms on one core; a recent one takes no time. The model reads at most 512 tokens of a
        text.
        """
        model = self._loaded()  # load the model before numpy is imported: the model's error says what to install
        import numpy as np

        mine = threading.Event()
        with self._lock:
            known = {text: self._latest[text] for text in texts if text in self._latest}
            new = [text for text in dict.fromkeys(texts) if text not in known and text not in self._running]
            others = {self._running[text] for text in texts if text in self._running}
            self._running.update(dict.fromkeys(new, mine))
        try:
            known.update(zip(new, self._encode(new), strict=True) if new else ())
        finally:
            with self._lock:
                for text in new:
                    del self._running[text]
                keep_latest(self._latest, known, REMEMBERED)
            mine.set()
        for other in others:  # another thread encodes the same utterance
            other.wait()
        with self._lock:
            known = {text: self._latest[text] for text in texts if text in self._latest} | known
        lost = [text for text in dict.fromkeys(texts) if text not in known]
        known.update(zip(lost, self._encode(lost), strict=True) if lost else ())
        return np.stack([known[text] for text in texts]) if texts else np.zeros((0, model.width), dtype=np.float32)

    def encode_lasting(self, texts: Sequence[str]) -> Rows:
        """Return the vectors of texts that stay the same each time the program starts, such as examples.

        The vectors of the built-in examples come with the package. The first call encodes all other texts, and writes
        their vectors to a file in the user's cache. If that file is missing or broken, the next call encodes them
        again.
        """
        model = self._loaded()
        import numpy as np

        known, packed = built_in(texts, self.size) if self._folder is None else (np.zeros(len(texts), np.bool_), None)
        if packed is not None and known.all():
            return Rows(packed)
        rows = np.zeros((len(texts), model.width), dtype=np.float32)
        if packed is not None:
            rows[known] = Rows(packed).unpacked()
        new = list(dict.fromkeys(text for text, is_known in zip(texts, known.tolist(), strict=True) if not is_known))
        if new:
            key = ["vectors", self.identity, new]
            found = cached(key, lambda: {"rows": self._encode(new).astype(np.float16)})["rows"]
            place = {text: number for number, text in enumerate(new)}
            rows[~known] = found[[place[text] for text in texts if text in place]]
        return Rows(rows)

    @property
    def size(self) -> int:
        """The size of the model's file in bytes."""
        return (self._loaded().folder / "model.onnx").stat().st_size

    @property
    def identity(self) -> list[object]:
        """The model's folder, size, date, and kind of multiplication. If these are the same, so are the vectors."""
        folder = self._loaded().folder
        return [str(folder), self.size, (folder / "model.onnx").stat().st_mtime_ns, "without overflow"]

    def _loaded(self) -> SentenceModel:
        if self._model is None:
            self._model = model_in(self._folder, BUNDLED)
        return self._model

    def _encode(self, texts: Sequence[str]) -> NDArray[np.float32]:
        model = self._loaded()
        import numpy as np

        if self._mean is None:
            self._mean = _pools_by_mean(model.folder)
        rows = np.zeros((len(texts), model.width), dtype=np.float32)
        # One text per run: a quantised model scales by the whole batch, so other texts would change a text's vector.
        for number, text in enumerate(texts):
            _, hidden, mask = next(model.run([text]))
            rows[number] = _pooled(hidden, mask, self._mean)[0]
        norms = np.linalg.norm(rows, axis=1, keepdims=True)
        return rows / np.maximum(norms, 1e-12)


def _pooled(hidden: NDArray[Any], mask: NDArray[Any], mean: bool) -> NDArray[Any]:
    """Return one vector for each text, from its tokens' vectors of shape (n, tokens, d)."""
    if hidden.ndim == 2:  # the model itself has pooled the tokens
        return hidden
    if not mean:
        return hidden[:, 0]
    weights = mask[:, :, None].astype(hidden.dtype)
    return (hidden * weights).sum(axis=1) / weights.sum(axis=1)


def _pools_by_mean(folder: Path) -> bool:
    """Return whether the vector of a text is the mean over its tokens. If not, it is the vector of the first token."""
    try:
        config = json.loads((folder / "1_Pooling" / "config.json").read_text(encoding="utf-8"))
        return bool(config["pooling_mode_mean_tokens"])
    except (OSError, ValueError, LookupError, TypeError):
        return False
