"""Train the network that reads utterances, and write ``language/reader.onnx``.

python tools/networks/train.py            train; about 90 minutes on 2 cores
python tools/networks/train.py --check    exit code 1 if the sentences have changed since the last training

The README describes the sentences. Training needs two packages that ravestate itself does not need:
pip install torch onnx
"""

from __future__ import annotations

import argparse
import random
import sys
import time
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from classes import Classes
from facts import LABELS, Facts
from replies import Replies
from rows import LAYERS, WIDTH, Row, batches, digest, padded
from trunk import trunk

from ravestate.language.lexicon import load_lexicon

OUT = Path(__file__).parents[2] / "src" / "ravestate" / "language" / "reader.onnx"
LESSONS = {"classes": Classes, "facts": Facts, "replies": Replies}
"""The name of a head's part in the network → the sentences and the head."""
BATCH = 32
"""The number of texts in a batch."""


@dataclass(frozen=True)
class Stage:
    """A part of the training."""

    shares: dict[str, float]
    """The name of a lesson → the share of its sentences that an epoch reads."""
    epochs: int
    rate: float
    """The learning rate of the heads."""
    trunk_rate: float
    """The learning rate of the trunk; 0 if only the heads learn."""


STAGES = (
    Stage({"replies": 1.0}, 5, 1e-3, 1.5e-4),
    Stage({"classes": 1.0, "replies": 0.33}, 5, 1e-3, 1e-4),
    Stage({"facts": 1.0}, 12, 3e-3, 0.0),
)
"""The replies are the hardest lesson, so they come first. The head of the facts does not need the trunk."""


def network(torch: Any, lessons: dict[str, Any]) -> Any:
    """Return a new network: the trunk and the heads."""
    nn = torch.nn

    class Network(nn.Module):  # type: ignore[misc, name-defined]
        def __init__(self) -> None:
            super().__init__()
            self.trunk = trunk(torch)
            self.heads = nn.ModuleDict({name: lesson.head(torch) for name, lesson in lessons.items()})

        def forward(self, vectors: Any, marks: Any, asked: Any) -> tuple[Any, ...]:
            read = self.trunk(vectors, marks, asked)
            return tuple(one for head in self.heads.values() for one in head.outputs(read).values())

    return Network()


def train(torch: Any, made: Any, lessons: dict[str, Any], stage: Stage) -> None:
    """Train a network for one stage. A batch has the sentences of one lesson."""
    order = random.Random(0)

    def epoch_of() -> list[tuple[str, list[Row]]]:
        found: list[tuple[str, list[Row]]] = []
        for name, share in stage.shares.items():
            rows: list[Row] = lessons[name].rows
            chosen = rows if share == 1 else order.sample(rows, round(share * len(rows)))
            found += [(name, batch) for batch in batches(chosen, BATCH, order)]
        order.shuffle(found)
        return found

    trunk, frozen = made.trunk, stage.trunk_rate == 0
    heads = [*made.heads.parameters(), *([] if frozen else trunk.mark.parameters())]
    groups = [{"params": heads}, *([] if frozen else [{"params": list(trunk.layers.parameters())}])]
    rates = [stage.rate, stage.trunk_rate][: len(groups)]
    optimiser = torch.optim.AdamW(groups, weight_decay=0.05)
    made.zero_grad()  # an earlier stage leaves gradients of parts that this stage does not train
    sizes = (round(share * len(lessons[name].rows)) for name, share in stage.shares.items())
    steps = stage.epochs * sum(-(-size // BATCH) for size in sizes)
    schedule = torch.optim.lr_scheduler.OneCycleLR(optimiser, rates, total_steps=steps, pct_start=0.1)
    for epoch in range(stage.epochs):
        began, lost = time.monotonic(), dict.fromkeys(stage.shares, 0.0)
        made.train()
        if frozen:
            trunk.eval()
        told = epoch_of()
        counts = Counter(name for name, _ in told)
        for done, (name, batch) in enumerate(told):
            if done % 200 == 0:
                print(f"epoch {epoch + 1} of {stage.epochs}: {done / len(told):.0%}", end="\r", flush=True)
            with torch.set_grad_enabled(not frozen):
                read = trunk(*padded(torch, batch))
            loss = made.heads[name].loss(read, batch)
            optimiser.zero_grad()
            loss.backward()
            torch.nn.utils.clip_grad_norm_(made.parameters(), 1.0)
            optimiser.step()
            schedule.step()
            lost[name] += loss.item() / counts[name]
        losses = ", ".join(f"{name} {loss:.3f}" for name, loss in lost.items())
        print(f"epoch {epoch + 1} of {stage.epochs}: {losses}, {time.monotonic() - began:.0f} s", flush=True)
    made.eval()


def write(torch: Any, made: Any, lessons: dict[str, Any], file: Path) -> None:
    """Write a network as an ONNX file with 8-bit weights. The metadata has the labels of the heads."""
    import onnx
    from onnxruntime.quantization import QuantType, quantize_dynamic

    made.eval()
    made.heads["replies"].fix()
    example = {
        "vectors": torch.zeros(1, 9, LAYERS * WIDTH),
        "marks": torch.zeros(1, 9, dtype=torch.long),
        "asked": torch.zeros(1, dtype=torch.long),
    }
    read = made.trunk(*example.values())
    outputs = [name for head in made.heads.values() for name in head.outputs(read)]
    free = {name: {1: "tokens"} for name in ("vectors", "marks", "facts", "denials")}
    whole = file.with_suffix(".whole.onnx")
    names = {"input_names": list(example), "output_names": outputs}
    torch.onnx.export(
        made, tuple(example.values()), str(whole), **names, dynamic_axes=free, dynamo=False, opset_version=17
    )
    quantize_dynamic(str(whole), str(file), per_channel=True, weight_type=QuantType.QInt8)
    whole.unlink()
    model = onnx.load(str(file))
    about = {head: ";".join(labels) for lesson in lessons.values() for head, labels in lesson.labels.items()}
    onnx.helper.set_model_props(model, {**about, "sentences": known_sentences()})
    onnx.save(model, str(file))
    print(f"{file.name}: {file.stat().st_size / 1e6:.1f} MB")


def known_sentences() -> str:
    """Return a hash of all files with sentences."""
    return digest(file for lesson in LESSONS.values() for file in lesson.files)


def main(arguments: Sequence[str]) -> int:
    """Train and write, or check; return the exit code."""
    parser = argparse.ArgumentParser(description="Train the network that reads utterances.")
    parser.add_argument("--check", action="store_true", help="train nothing; exit code 1 if the sentences have changed")
    if parser.parse_args(arguments).check:
        import onnxruntime

        about = onnxruntime.InferenceSession(str(OUT)).get_modelmeta().custom_metadata_map
        same = about["sentences"] == known_sentences() and about["facts"] == ";".join(LABELS)
        print(
            "reader.onnx knows these sentences"
            if same
            else "the sentences have changed: python tools/networks/train.py"
        )
        return int(not same)
    import torch

    torch.manual_seed(0)
    load_lexicon()
    lessons = {name: lesson() for name, lesson in LESSONS.items()}
    print(", ".join(f"{name}: {len(lesson.rows)} texts" for name, lesson in lessons.items()), flush=True)
    made = network(torch, lessons)
    for stage in STAGES:
        train(torch, made, lessons, stage)
    write(torch, made, lessons, OUT)
    return 0


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
