"""Small networks on top of the bundled sentence model. ``tools/networks`` trains them."""

from __future__ import annotations

import os
import threading
from collections.abc import Collection, Mapping
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


BEFORE = 24
"""The maximum number of tokens that a network reads of the user's previous utterance. The same maximum applies to
the agent's answer to that utterance."""
EARLIER, SAID = 2, 3
"""`EARLIER` marks the tokens of the user's previous utterance. `SAID` marks the tokens of the agent's answer to it."""
LATEST = 16
"""The number of texts whose vectors are kept, because several networks read one utterance."""


class Network:
    """A network that reads each token's vectors after several layers of the encoder. Thread-safe."""

    def __init__(self, file: Path) -> None:
        """Choose a file; load nothing yet.

        Args:
            file: An ONNX file. Its inputs are ``vectors`` (1, tokens, layers * 384), ``marks`` (1, tokens: 1 for a capital,
                `EARLIER` or `SAID` for what came before) and perhaps ``context`` (1,). Its metadata has ``labels`` with
                semicolons between them. In the metadata, ``before`` is 1 if the network reads the user's previous
                utterance. ``said`` is 1 if the network reads the agent's answer to that utterance.
        """
        self._file = file
        self._lock = threading.Lock()
        self._session: Any = None
        self.labels: list[str] = []
        self.about: Mapping[str, str] = {}
        """The metadata of the file."""
        self._marks: Collection[int] = ()

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
                f"the sentence model {BUNDLED} lacks the layers that the networks read: {requirement(SENTENCE_MODELS)}"
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
            about = session.get_modelmeta().custom_metadata_map
            labels = about["labels"]
        except Exception as error:  # the library has its own exceptions, with long messages
            raise PlatformError(f"the network {str(self._file)!r} is broken: install ravestate again") from error
        self.labels, self.about = labels.split(";"), about
        self._marks = [mark for name, mark in (("before", EARLIER), ("said", SAID)) if about.get(name) == "1"]
        return session

    def run(
        self, text: str, context: int | None = None, before: str = "", said: str = ""
    ) -> tuple[list[tuple[int, int]], list[NDArray[Any]]]:
        """Return the span of each token in a text, and the outputs of the network for the text.

        Args:
            text: One or more sentences in normal form.
            context: The index of the label that the agent has just asked for, counted from 1; 0 for no label. Pass None if
                the network has no such input.
            before: The user's previous utterance. If the network reads it, its tokens come first, and the outputs have
                more tokens than the spans.
            said: The agent's answer to the previous utterance. Its tokens come between those of `before` and `text`.
        """
        import numpy as np

        spans, vectors = _vectors(text)
        marks = [int(start < end and text[start].isupper()) for start, end in spans]
        for earlier, mark in ((said, SAID), (before, EARLIER)):
            if earlier and mark in self._marks:
                tokens = _vectors(earlier)[1][:BEFORE]
                vectors, marks = np.concatenate([tokens, vectors]), [mark] * len(tokens) + marks
        given = {"vectors": vectors[None], "marks": np.array([marks])}
        if context is not None:
            given["context"] = np.array([context])
        return spans, self._session.run(None, given)


@lru_cache(LATEST)
def _vectors(text: str) -> tuple[list[tuple[int, int]], NDArray[Any]]:
    return model_in(None, BUNDLED).token_vectors(text)
