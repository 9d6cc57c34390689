"""Train the tagger of facts on the marked sentences in ``facts``, and write ``persqa/facts.onnx``.

python tools/networks/facts.py            train; about 15 minutes on 2 cores
python tools/networks/facts.py --check    exit code 1 if the sentences have changed since the last training

Training needs two packages that ravestate itself does not need: pip install torch onnx
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from marks import Marked, Value, read
from shared import SRC, WIDTH, Row, checked, digest, mixer, padded, run, trained, write

from ravestate.language.lexicon import load_lexicon
from ravestate.language.normal import normalise
from ravestate.modules.skill.persqa.topics import TOPICS

FILES = sorted((Path(__file__).parent / "facts").glob("*.txt"))
OUT = SRC / "modules" / "skill" / "persqa" / "facts.onnx"
LABELS = [*TOPICS, "favourite"]
LAYERS, HIDDEN, DROPOUT = 5, 192, 0.3
EPOCHS, BATCH, RATE = 12, 64, 3e-3


def row_of(sentence: Marked) -> Row:
    """Return a sentence in its normal form, with the vectors and classes of its tokens.

    Class 0 is *no value*. A label has two classes: 1 + 2 * label for the first token of a value, 2 + 2 * label for the
    others. `Row.denied` is 1 if the value is denied, 0 if it holds, -1 without a value.
    """
    normal = normalise(sentence.text)
    row = Row(normal.text)
    row.classes, row.denied = [0] * len(row), [-1.0] * len(row)
    row.context = LABELS.index(sentence.context) + 1 if sentence.context in LABELS else 0
    for value in sentence.values:
        start, end = _moved(value, normal.origin, len(normal.text))
        first = True
        for number, (left, right) in enumerate(row.spans):
            if left < right and left < end and right > start:
                row.classes[number] = 2 * LABELS.index(value.label) + (1 if first else 2)
                row.denied[number] = float(value.negated)
                first = False
    return row


def _moved(value: Value, origin: Sequence[int], length: int) -> tuple[int, int]:
    """Return the span of a value in the normal form of its text."""
    inside = [at for at in range(length) if value.start <= origin[at] < value.end and origin[at] < origin[at + 1]]
    return (inside[0], inside[-1] + 1) if inside else (0, 0)


def network(torch: Any) -> Any:
    """Return a new network: two bidirectional LSTM layers, and two outputs per token."""
    nn = torch.nn

    class Network(nn.Module):  # type: ignore[misc, name-defined]
        def __init__(self) -> None:
            super().__init__()
            self.mixer = mixer(torch, LAYERS)
            self.before, self.after = nn.LayerNorm(WIDTH), nn.LayerNorm(2 * HIDDEN)
            self.context = nn.Embedding(len(LABELS) + 1, WIDTH)
            nn.init.normal_(self.context.weight, 0, 0.1)
            self.lstm = nn.LSTM(WIDTH, HIDDEN, 2, batch_first=True, bidirectional=True, dropout=DROPOUT)
            self.drop = nn.Dropout(DROPOUT)
            self.classes, self.denied = nn.Linear(2 * HIDDEN, 1 + 2 * len(LABELS)), nn.Linear(2 * HIDDEN, 1)

        def forward(self, vectors: Any, marks: Any, context: Any, lengths: Any = None) -> tuple[Any, Any]:
            tokens = self.before(self.mixer(vectors, marks)) + self.context(context)[:, None]
            tokens = self.drop(self.after(run(torch, self.lstm, self.drop(tokens), lengths)))
            classes, denied = self.classes(tokens), self.denied(tokens)[..., 0]
            return (classes.softmax(-1), denied.sigmoid()) if lengths is None else (classes, denied)

    return Network()


def main(arguments: Sequence[str]) -> int:
    """Train and write, or check; return the exit code."""
    if "--check" in arguments:
        return checked(OUT, FILES, "python tools/networks/facts.py")
    import torch

    torch.manual_seed(0)
    load_lexicon()
    rows = [row_of(one) for one in read(FILES)]
    print(f"{len(rows)} sentences", flush=True)
    functions = torch.nn.functional

    def loss_of(made: Any, batch: list[Row]) -> Any:
        vectors, marks, lengths = padded(torch, batch)
        longest = vectors.shape[1]
        classes = torch.tensor([row.classes + [-100] * (longest - len(row)) for row in batch])
        denied = torch.tensor([row.denied + [-1.0] * (longest - len(row)) for row in batch])
        found, denials = made(vectors, marks, torch.tensor([row.context for row in batch]), lengths)
        loss = functions.cross_entropy(found.flatten(0, 1), classes.flatten(), ignore_index=-100, label_smoothing=0.05)
        valued = denied >= 0
        if valued.any():
            loss = loss + 0.3 * functions.binary_cross_entropy_with_logits(denials[valued], denied[valued])
        return loss

    made = trained(torch, network(torch), rows, loss_of, EPOCHS, BATCH, RATE)
    about = {"labels": ";".join(LABELS), "sentences": digest(FILES)}
    write(torch, made, OUT, LAYERS, ["chances", "denials"], about, context=True)
    return 0


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
