"""Train a classifier on the files in a folder, and write it into the module that uses it.

python tools/networks/sentences.py answers            train; 2 minutes on 2 cores
python tools/networks/sentences.py answers --check    exit code 1 if the sentences have changed

Each line of the files has a text and its class, with a tab between them. Training
needs two packages that ravestate itself does not need: pip install torch onnx
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from shared import SRC, WIDTH, Row, checked, digest, mixer, padded, run, trained, write

from ravestate.language.lexicon import load_lexicon
from ravestate.language.normal import normalise

HERE = Path(__file__).parent
LAYERS, HIDDEN, DROPOUT = 5, 128, 0.4
EPOCHS, BATCH, RATE = 14, 64, 2e-3
OUT = {"answers": SRC / "modules" / "meta" / "nlp" / "answers.onnx"}


def cases(files: Sequence[Path]) -> dict[str, str]:
    """Return the texts of some files, each with its class."""
    lines = [line for file in files for line in file.read_text(encoding="utf-8").splitlines()]
    rows = (line.split("\t") for line in lines if "\t" in line and not line.startswith("#"))
    return {text.strip(): name.strip() for text, name in rows}


def normal_form(text: str) -> str:
    """Return a text as `nlp` gives it to the classifier: question marks that the user has not typed are left out."""
    written = normalise(text).text
    return written if "?" in text else written.replace("?", ".")


def network(torch: Any, classes: int) -> Any:
    """Return a new network: a bidirectional LSTM, of whose outputs it takes the maximum, the mean, and a weighted mean."""
    nn = torch.nn

    class Network(nn.Module):  # type: ignore[misc, name-defined]
        def __init__(self) -> None:
            super().__init__()
            self.mixer = mixer(torch, LAYERS)
            self.lstm = nn.LSTM(WIDTH, HIDDEN, 1, batch_first=True, bidirectional=True)
            self.drop = nn.Dropout(DROPOUT)
            self.weight, self.out = nn.Linear(2 * HIDDEN, 1), nn.Linear(6 * HIDDEN, classes)

        def forward(self, vectors: Any, marks: Any, lengths: Any = None) -> Any:
            tokens = run(torch, self.lstm, self.drop(self.mixer(vectors, marks)), lengths)
            weights = self.weight(tokens)[..., 0]
            if lengths is None:
                pooled = [(weights.softmax(1)[..., None] * tokens).sum(1), tokens.max(1)[0], tokens.mean(1)]
                return self.out(torch.cat(pooled, 1)).softmax(-1)
            real = torch.arange(tokens.shape[1])[None] < lengths[:, None]
            weights = weights.masked_fill(~real, -1e9).softmax(1)
            mean = (tokens * real[..., None]).sum(1) / lengths[:, None]
            highest = tokens.masked_fill(~real[..., None], -9.0).max(1)[0]
            return self.out(self.drop(torch.cat([(weights[..., None] * tokens).sum(1), highest, mean], 1)))

    return Network()


def main(arguments: Sequence[str]) -> int:
    """Train and write, or check; return the exit code."""
    if not arguments or arguments[0] not in OUT:
        print(__doc__)
        return 2
    name = arguments[0]
    out = OUT[name]
    files = sorted((HERE / name).glob("*.tsv"))
    if "--check" in arguments:
        return checked(out, files, f"python tools/networks/sentences.py {name}")
    import torch

    torch.manual_seed(0)
    load_lexicon()
    known = cases(files)
    labels = sorted(set(known.values()))
    rows = [Row(normal_form(text), longest=64) for text in known]
    for row, label in zip(rows, known.values(), strict=True):
        row.classes = [labels.index(label)]
    print(f"{len(rows)} sentences, {len(labels)} classes", flush=True)

    def loss_of(made: Any, batch: list[Row]) -> Any:
        vectors, marks, lengths = padded(torch, batch)
        wanted = torch.tensor([row.classes[0] for row in batch])
        return torch.nn.functional.cross_entropy(made(vectors, marks, lengths), wanted, label_smoothing=0.1)

    made = trained(torch, network(torch, len(labels)), rows, loss_of, EPOCHS, BATCH, RATE)
    about = {"labels": ";".join(labels), "sentences": digest(files)}
    write(torch, made, out, LAYERS, ["classes"], about)
    return 0


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
