"""The network that reads an utterance, with an output for each purpose.

The network (``reader.onnx``) continues the bundled sentence model: its own six layers read the vectors that the sentence
model has after its sixth layer. Several small heads read the result. They find the meaning of an answer, the kind of a
question, and the next move of a listener. Others find the values of facts, and the replies that suit. `Classifier`,
`Tagger` and `Replies` are views of these heads. ``tools/networks`` has the training.
"""

from __future__ import annotations

import os
import threading
from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ravestate.errors import PlatformError

from .bundled import SENTENCE_MODELS, requirement
from .encoder import BUNDLED
from .heap import note_load
from .loading import LOADING
from .model import model_in

if TYPE_CHECKING:
    from numpy.typing import NDArray

LONGEST = 300
"""The maximum number of characters of an utterance that a head for whole texts reads."""
BEFORE = 24
"""The maximum number of tokens that the network reads of the user's previous utterance. The same maximum applies to
the agent's answer to that utterance."""
EARLIER, SAID = 2, 3
"""`EARLIER` marks the tokens of the user's previous utterance. `SAID` marks the tokens of the agent's answer to it."""
LATEST, VECTORS = 64, 8
"""The number of texts whose outputs are kept, because several modules read one utterance; and the number of texts whose
vectors are kept. The outputs of a short text take 13 kB, and the vectors of a token 8 kB."""


class Network:
    """A network that reads each token's vectors after several layers of the sentence model. Thread-safe."""

    def __init__(self, file: Path) -> None:
        """Choose a file; load nothing yet.

        Args:
            file: An ONNX file. Its inputs are ``vectors`` (1, tokens, layers * 384), ``marks`` (1, tokens: 1 for a capital,
                `EARLIER` or `SAID` for what came before) and ``asked`` (1,). Its metadata has the name of each head, and the
                head's labels with semicolons between them.
        """
        self._file = file
        self._lock = threading.Lock()
        self._session: Any = None
        self._labels: dict[str, list[str]] = {}
        self._outputs: list[str] = []
        self._latest = lru_cache(LATEST)(self._read)

    @property
    def loaded(self) -> bool:
        """Whether the network is ready."""
        return self._session is not None

    def load(self) -> None:
        """Load the encoder and the network, once.

        Raises:
            PlatformError: The sentence model is missing (`ModelMissing`), or a file is broken.
        """
        base = model_in(None, BUNDLED)
        if not base.layers:
            raise PlatformError(
                f"the sentence model {BUNDLED} lacks the layers that the network reads: {requirement(SENTENCE_MODELS)}"
            )
        with self._lock:
            if self._session is None:
                with LOADING:
                    self._session = self._opened()
                    note_load()

    def _opened(self) -> Any:
        os.environ.setdefault("ORT_DISABLE_TELEMETRY", "1")
        import onnxruntime  # pyright: ignore[reportMissingTypeStubs]

        runtime: Any = onnxruntime
        options = runtime.SessionOptions()
        options.intra_op_num_threads = options.inter_op_num_threads = 1
        # Without this option, integer products overflow on processors without VNNI, and results differ by machine.
        options.add_session_config_entry("session.x64quantprecision", "1")
        options.enable_cpu_mem_arena = options.enable_mem_pattern = False
        options.log_severity_level = 4  # log no errors, because they are raised as exceptions
        try:
            session = runtime.InferenceSession(str(self._file), options, providers=["CPUExecutionProvider"])
            about: Mapping[str, str] = session.get_modelmeta().custom_metadata_map
            self._labels = {head: labels.split(";") for head, labels in about.items() if head != "sentences"}
            self._outputs = [one.name for one in session.get_outputs()]
        except Exception as error:  # the library has its own exceptions, with long messages
            raise PlatformError(f"the network {str(self._file)!r} is broken: install ravestate again") from error
        return session

    def labels(self, head: str) -> list[str]:
        """Return the labels of a head; none before `load`."""
        return self._labels.get(head, [])

    def read(self, text: str, before: str = "", said: str = "", asked: int = 0) -> Mapping[str, NDArray[Any]]:
        """Return the outputs for a text by their names, each without its first axis; none before `load`.

        ``spans`` is the span of each token of the text, shape (tokens, 2). The network reads at most 512 tokens.

        Args:
            text: One or more sentences in normal form.
            before: The user's previous utterance in normal form; empty if there is none.
            said: The agent's answer to the previous utterance; empty if there is none.
            asked: The place of the fact that the agent has just asked for, in the labels of the head ``facts``, counted
                from 1; 0 if it has asked for none.
        """
        return self._latest(text, before, said, asked) if self.loaded and text.strip() else {}

    def _read(self, text: str, before: str, said: str, asked: int) -> Mapping[str, NDArray[Any]]:
        import numpy as np

        spans, vectors = _vectors(text)
        marks = [int(start < end and text[start].isupper()) for start, end in spans]
        for earlier, mark in ((said, SAID), (before, EARLIER)):
            if earlier:
                tokens = _vectors(earlier)[1][:BEFORE]
                vectors, marks = np.concatenate([tokens, vectors]), [mark] * len(tokens) + marks
        numbers = {"marks": np.array([marks], dtype=np.int64), "asked": np.array([asked], dtype=np.int64)}
        found = [one[0] for one in self._session.run(None, {"vectors": vectors[None], **numbers})]
        for one in found:
            one.flags.writeable = False  # all readers share the arrays
        return {**dict(zip(self._outputs, found, strict=True)), "spans": np.array(spans)}


@lru_cache(VECTORS)
def _vectors(text: str) -> tuple[list[tuple[int, int]], NDArray[Any]]:
    return model_in(None, BUNDLED).token_vectors(text)


_NETWORK = Network(Path(__file__).with_name("reader.onnx"))


def network() -> Network:
    """Return the bundled network, which all contexts share. It may not be loaded yet."""
    return _NETWORK
