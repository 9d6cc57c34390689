"""Train a classifier on the files in a folder, and write it into the module that uses it.

python tools/networks/sentences.py answers            train; 3 to 20 minutes on 2 cores
python tools/networks/sentences.py answers --check    exit code 1 if the sentences have changed

Each line of the files has a text and its classes, with a tab between them: see the README. Training
needs two packages that ravestate itself does not need: pip install torch onnx
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from shared import SRC, WIDTH, Row, checked, digest, mixer, padded, run, trained, write

from ravestate.language.lexicon import load_lexicon
from ravestate.language.network import EARLIER
from ravestate.language.normal import normalise

HERE = Path(__file__).parent
LAYERS, HIDDEN, DROPOUT = 5, 128, 0.4
EPOCHS, BATCH, RATE = 9, 128, 2e-3
SHARES = 1.0, 0.6, 0.4, 0.3
"""The relative shares of the first class of a text, the second..."""
SPREAD = 0.1
"""Label smoothing: the share of the target that is spread over all classes."""
WRONG = 0.5
"""The weight of the penalty for classes that are marked as wrong."""
MODULES = SRC / "modules"
OUT = {
    "answers": MODULES / "meta" / "nlp" / "answers.onnx",
    "kinds": MODULES / "meta" / "nlp" / "kinds.onnx",
    "responses": MODULES / "skill" / "wildtalk" / "listening" / "responses.onnx",
}


def cases(files: Sequence[Path]) -> dict[str, tuple[str, list[str]]]:
    """Return the texts of some files, each with the utterance before it (empty if there is none), and its classes."""
    found: dict[str, tuple[str, list[str]]] = {}
    for file in files:
        before = ""
        for line in file.read_text(encoding="utf-8").splitlines():
            if line.startswith("#"):  # another talk begins
                before = ""
            elif "\t" in line:
                text, names = line.split("\t")
                found[text.strip()] = before, [name.strip() for name in names.split(",")]
                before = text.strip() if file.name.startswith("talks") else ""
    return found


def network(torch: Any, classes: int) -> Any:
    """Return a new network: a bidirectional LSTM, of whose outputs it takes the maximum, the mean, and a weighted mean."""
    nn = torch.nn

    class Network(nn.Module):  # type: ignore[misc, name-defined]
        def __init__(self) -> None:
            super().__init__()
            self.mixer = mixer(torch, LAYERS, 1 + EARLIER)
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


def loss(torch: Any, made: Any, batch: Sequence[Row], classes: int) -> Any:
    """Return the cross-entropy of the right classes, plus a penalty for the probability of the wrong ones."""
    right, wrong = torch.zeros(len(batch), classes), torch.zeros(len(batch), classes)
    for number, row in enumerate(batch):
        for label, share in zip(row.classes, SHARES, strict=False):
            right[number, label] = share / sum(SHARES[: len(row.classes)])
        wrong[number, row.wrong] = 1
    vectors, marks, lengths = padded(torch, batch)
    logs = made(vectors, marks, lengths).log_softmax(1)
    hits = -((right * (1 - SPREAD) + SPREAD / classes) * logs).sum(1)
    misses = -(torch.log1p(-logs.exp().clamp(max=0.999)) * wrong).sum(1)
    return (hits + WRONG * misses).mean()


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
    labels = sorted({label for _, names in known.values() for label in names if not label.startswith("!")})
    rows = {text: Row(normalise(text).unguessed, longest=64) for text in known}
    for row, (before, names) in zip(rows.values(), known.values(), strict=True):
        row.before = rows.get(before)
        row.classes = [labels.index(label) for label in names if label in labels]
        row.wrong = [labels.index(label[1:]) for label in names if label[1:] in labels and label.startswith("!")]
    print(f"{len(rows)} sentences, {len(labels)} classes", flush=True)

    def loss_of(made: Any, batch: list[Row]) -> Any:
        return loss(torch, made, batch, len(labels))

    made = trained(torch, network(torch, len(labels)), list(rows.values()), loss_of, EPOCHS, BATCH, RATE)
    reads_before = any(row.before is not None for row in rows.values())
    about = {"labels": ";".join(labels), "sentences": digest(files), "before": str(int(reads_before))}
    write(torch, made, out, LAYERS, ["classes"], about)
    return 0


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
