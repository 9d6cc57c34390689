"""Train a classifier on the files in a folder, and write it into the module that uses it.

python tools/networks/sentences.py answers            train; 3 minutes on 2 cores
python tools/networks/sentences.py answers --check    exit code 1 if the sentences have changed

Each line of the files has a text and its class, with a tab between them: see the README. Training
needs two packages that ravestate itself does not need: pip install torch onnx
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from shared import HIDDEN, SRC, Row, checked, digest, padded, reader, trained, write

from ravestate.language.lexicon import load_lexicon
from ravestate.language.normal import normalise

HERE = Path(__file__).parent
LAYERS, DROPOUT = 5, 0.4
EPOCHS, BATCH, RATE = 9, 128, 2e-3
SPREAD = 0.1
"""Label smoothing: the share of the target that is spread over all classes."""
MODULES = SRC / "modules"
OUT = {
    "answers": MODULES / "meta" / "nlp" / "answers.onnx",
    "kinds": MODULES / "meta" / "nlp" / "kinds.onnx",
}


def cases(files: Sequence[Path]) -> dict[str, str]:
    """Return the texts of some files, and the class of each."""
    lines = (line for file in files for line in file.read_text(encoding="utf-8").splitlines() if "\t" in line)
    return {text.strip(): name.strip() for text, name in (line.split("\t") for line in lines)}


def network(torch: Any, classes: int) -> Any:
    """Return a new network: a reader, and a layer for the classes."""
    nn = torch.nn

    class Network(nn.Module):  # type: ignore[misc, name-defined]
        def __init__(self) -> None:
            super().__init__()
            self.reader, self.out = reader(torch, LAYERS, DROPOUT), nn.Linear(6 * HIDDEN, classes)

        def forward(self, vectors: Any, marks: Any, lengths: Any = None) -> Any:
            found = self.out(self.reader(vectors, marks, lengths))
            return found.softmax(-1) if lengths is None else found

    return Network()


def loss(torch: Any, made: Any, batch: Sequence[Row]) -> Any:
    """Return the cross-entropy of the right classes."""
    right = torch.tensor([row.classes[0] for row in batch])
    return torch.nn.functional.cross_entropy(made(*padded(torch, batch)), right, label_smoothing=SPREAD)


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
    rows = [Row(normalise(text).unguessed, longest=64) for text in known]
    for row, label in zip(rows, known.values(), strict=True):
        row.classes = [labels.index(label)]
    print(f"{len(rows)} sentences, {len(labels)} classes", flush=True)
    made = trained(
        torch, network(torch, len(labels)), rows, lambda made, batch: loss(torch, made, batch), EPOCHS, BATCH, RATE
    )
    about = {"labels": ";".join(labels), "sentences": digest(files)}
    write(torch, made, out, LAYERS, ["classes"], about)
    return 0


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
