"""The parts of the training that all networks share: vectors, batches, the loop, and the ONNX file."""

from __future__ import annotations

import hashlib
import random
import time
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ravestate.language.encoder import BUNDLED
from ravestate.language.model import model_in
from ravestate.language.network import BEFORE, EARLIER, SAID

SRC = Path(__file__).parents[2] / "src" / "ravestate"
KEPT = 0.7
"""The chance that a text is read together with each of the texts before it. The network must also work without them."""
WIDTH = 384
"""The length of a token's vector after one layer."""
HIDDEN = 128
"""The size of the LSTM of a reader, in each direction."""


class Row:
    """A text as a network sees it: the vectors of its tokens, and the classes to learn."""

    def __init__(self, text: str, longest: int = 96) -> None:
        spans, vectors = model_in(None, BUNDLED).token_vectors(text)
        self.spans = spans[:longest]
        self.vectors = vectors[:longest].astype(np.float16)
        """The vectors: shape (tokens, layers * WIDTH)."""
        capitals = [int(start < end and text[start].isupper()) for start, end in spans]
        self.marks = capitals[:longest]
        self.before: Row | None = None
        """The utterance before, in a talk."""
        self.said: Row | None = None
        """The agent's answer to the utterance before."""
        self.context = 0
        self.classes: list[int] = []
        self.denied: list[float] = []

    def __len__(self) -> int:
        return len(self.spans)


def digest(files: Iterable[Path]) -> str:
    """Return a short hash of the contents of some files."""
    found = hashlib.sha256()
    for file in sorted(files):
        found.update(file.read_bytes())
    return found.hexdigest()[:16]


def batches(rows: Sequence[Row], size: int, order: random.Random) -> list[list[Row]]:
    """Return the rows in a new order, in batches of similar length, because padding costs time."""
    ordered = sorted(rows, key=lambda row: len(_with_earlier(row)[1]) + order.random() * 4)
    found = [ordered[at : at + size] for at in range(0, len(ordered), size)]
    order.shuffle(found)
    return found


def padded(torch: Any, rows: Sequence[Row], *, noisy: bool = True) -> tuple[Any, Any, Any]:
    """Return the vectors, the marks and the lengths of some rows, perhaps with random noise against overfitting."""
    parts = [_with_earlier(row, lambda: torch.rand(1).item() < KEPT) for row in rows]
    longest = max(len(marks) for _, marks in parts)
    vectors = torch.zeros(len(rows), longest, rows[0].vectors.shape[1])
    marks = torch.zeros((len(rows), longest), dtype=torch.long)
    for number, (one, marked) in enumerate(parts):
        vectors[number, : len(marked)] = torch.from_numpy(one.astype(np.float32))
        marks[number, : len(marked)] = torch.tensor(marked)
    if noisy:
        vectors = vectors + torch.randn_like(vectors) * 0.05
        vectors = vectors * (torch.rand(vectors.shape[:2]) > 0.05)[..., None]
    return vectors, marks, torch.tensor([len(marks) for _, marks in parts])


def _with_earlier(row: Row, kept: Callable[[], bool] = lambda: True) -> tuple[Any, list[int]]:
    """Return the vectors and the marks of a text, after those of the texts before it that `kept` chooses."""
    vectors, marks = row.vectors, row.marks
    for one, mark in ((row.said, SAID), (row.before, EARLIER)):
        if one is not None and kept():
            earlier = one.vectors[:BEFORE]
            vectors, marks = np.concatenate([earlier, vectors]), [mark] * len(earlier) + marks
    return vectors, marks


def mixer(torch: Any, layers: int, marks: int = 2) -> Any:
    """Return the first part of all networks: a weighted mean of the layers, plus a vector for each kind of mark."""
    nn = torch.nn

    class Mixer(nn.Module):  # type: ignore[misc, name-defined]
        def __init__(self) -> None:
            super().__init__()
            self.weights = nn.Parameter(torch.zeros(layers))
            self.norms = nn.ModuleList([nn.LayerNorm(WIDTH) for _ in range(layers)])
            self.mark = nn.Embedding(marks, WIDTH)
            nn.init.normal_(self.mark.weight, 0, 0.1)

        def forward(self, vectors: Any, marks: Any) -> Any:
            weights, parts = self.weights.softmax(0), vectors.split(WIDTH, dim=2)
            return sum(weights[at] * self.norms[at](parts[at]) for at in range(layers)) + self.mark(marks)

    return Mixer()


def run(torch: Any, lstm: Any, tokens: Any, lengths: Any) -> Any:
    """Return the outputs of an LSTM for each token. Without `lengths`, there is a single text without padding."""
    if lengths is None:
        return lstm(tokens)[0]
    tools = torch.nn.utils.rnn
    packed = tools.pack_padded_sequence(tokens, lengths, batch_first=True, enforce_sorted=False)
    return tools.pad_packed_sequence(lstm(packed)[0], batch_first=True)[0]


def reader(torch: Any, layers: int, dropout: float) -> Any:
    """Return a network that reads a text: a bidirectional LSTM, of whose outputs it takes the maximum, the mean, and a
    weighted mean: 6 * HIDDEN numbers."""
    nn = torch.nn

    class Reader(nn.Module):  # type: ignore[misc, name-defined]
        def __init__(self) -> None:
            super().__init__()
            self.mixer = mixer(torch, layers, 1 + EARLIER)
            self.lstm = nn.LSTM(WIDTH, HIDDEN, 1, batch_first=True, bidirectional=True)
            self.drop = nn.Dropout(dropout)
            self.weight = nn.Linear(2 * HIDDEN, 1)

        def forward(self, vectors: Any, marks: Any, lengths: Any = None) -> Any:
            tokens = run(torch, self.lstm, self.drop(self.mixer(vectors, marks)), lengths)
            weights = self.weight(tokens)[..., 0]
            if lengths is None:
                return torch.cat([(weights.softmax(1)[..., None] * tokens).sum(1), tokens.max(1)[0], tokens.mean(1)], 1)
            real = torch.arange(tokens.shape[1])[None] < lengths[:, None]
            weights = weights.masked_fill(~real, -1e9).softmax(1)
            mean = (tokens * real[..., None]).sum(1) / lengths[:, None]
            highest = tokens.masked_fill(~real[..., None], -9.0).max(1)[0]
            return self.drop(torch.cat([(weights[..., None] * tokens).sum(1), highest, mean], 1))

    return Reader()


def trained(
    torch: Any,
    made: Any,
    rows: Sequence[Row],
    loss_of: Callable[[Any, list[Row]], Any],
    epochs: int,
    size: int,
    rate: float,
    slow: Sequence[Any] = (),
) -> Any:
    """Train a network, and return it. The parameters `slow` have been trained before, and learn at 15 % of the rate."""
    order, known = random.Random(0), {id(one) for one in slow}
    groups = [{"params": [one for one in made.parameters() if id(one) not in known]}, {"params": list(slow)}]
    optimiser = torch.optim.AdamW(groups[: 1 + bool(slow)], lr=rate, weight_decay=0.05)
    steps = epochs * -(-len(rows) // size)
    rates = [rate, 0.15 * rate][: 1 + bool(slow)]
    schedule = torch.optim.lr_scheduler.OneCycleLR(optimiser, rates, total_steps=steps, pct_start=0.1 if slow else 0.3)
    for epoch in range(epochs):
        began, total = time.monotonic(), 0.0
        made.train()
        for batch in batches(rows, size, order):
            loss = loss_of(made, batch)
            optimiser.zero_grad()
            loss.backward()
            torch.nn.utils.clip_grad_norm_(made.parameters(), 1.0)
            optimiser.step()
            schedule.step()
            total += loss.item() * len(batch)
        print(
            f"epoch {epoch + 1} of {epochs}: loss {total / len(rows):.3f}, {time.monotonic() - began:.0f} s", flush=True
        )
    return made.eval()


def write(
    torch: Any,
    made: Any,
    file: Path,
    layers: int,
    outputs: Sequence[str],
    about: dict[str, str],
    *,
    context: bool = False,
) -> None:
    """Write a network as an ONNX file with 8-bit weights, and `about` as its metadata."""
    import onnx
    from onnxruntime.quantization import QuantType, quantize_dynamic

    whole = file.with_suffix(".whole.onnx")
    example = {
        "vectors": torch.zeros(1, 9, layers * WIDTH),
        "marks": torch.zeros(1, 9, dtype=torch.long),
        **({"context": torch.zeros(1, dtype=torch.long)} if context else {}),
    }
    free = {name: {1: "tokens"} for name in ("vectors", "marks", "chances", "denials") if name in (*example, *outputs)}
    names = {"input_names": list(example), "output_names": list(outputs)}
    torch.onnx.export(
        made, tuple(example.values()), str(whole), **names, dynamic_axes=free, dynamo=False, opset_version=17
    )
    quantize_dynamic(str(whole), str(file), weight_type=QuantType.QInt8)
    whole.unlink()
    model = onnx.load(str(file))
    onnx.helper.set_model_props(model, about)
    onnx.save(model, str(file))
    print(f"{file.name}: {file.stat().st_size / 1e6:.1f} MB")


def checked(file: Path, files: Iterable[Path], command: str) -> int:
    """Print whether a network was trained on the present files; return the exit code."""
    import onnxruntime

    about = onnxruntime.InferenceSession(str(file)).get_modelmeta().custom_metadata_map
    same = about["sentences"] == digest(files)
    print(f"{file.name} knows these sentences" if same else f"the sentences of {file.name} have changed: {command}")
    return int(not same)
