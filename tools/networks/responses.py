"""Train the network that grades the replies of small talk, and write it into the module wildtalk.

python tools/networks/responses.py            train; 35 minutes on 2 cores
python tools/networks/responses.py --check    exit code 1 if the sentences or the grades have changed

The network learns two things from one text: the kinds of reply that suit (``responses/*.tsv``), and the grades that
readers gave to single replies (``responses/graded``). See the README. Training needs two packages that ravestate itself
does not need: pip install torch onnx
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

from shared import SRC, WIDTH, Row, checked, digest, padded, trained, write
from upper import upper_layers

from ravestate.language.encoder import BUNDLED, Encoder
from ravestate.language.lexicon import load_lexicon
from ravestate.language.model import LAYERS
from ravestate.language.network import EARLIER, SAID
from ravestate.language.normal import normalise

HERE = Path(__file__).parent / "responses"
GRADED = HERE / "graded"
OUT = SRC / "language" / "replies.onnx"
FIRST, PLACE, DROPOUT = 6, 1, 0.2
"""The network has its own layers from number FIRST on, of twelve. They read the sentence model's layer below, which is
number PLACE of those that the sentence model returns."""
SIZE = 96
"""The length of the two vectors that stand for a reply."""
EPOCHS, BATCH, RATE = 4, 32, 1e-3
SHARES = 1.0, 0.6, 0.4, 0.3
"""The relative shares of the first kind of a text, the second..."""
SPREAD = 0.1
"""Label smoothing: the share of the target that is spread over all kinds."""
WRONG = 0.5
"""The weight of the penalty for kinds that are marked as wrong."""
GRADES, BEST = 0.1, 0.2
"""The weight of the loss of one grade, and of the best reply of a text. A text has about ten grades."""
SHARP = 3
"""The factor of the grades in the loss of the best reply."""


def texts_in(files: Sequence[Path]) -> dict[str, tuple[str, list[str]]]:
    """Return the texts of some files, each with the utterance before it (empty if there is none), and its kinds."""
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


def replies_in(file: Path) -> list[tuple[str, str]]:
    """Return the replies in the order of their numbers, each with its kind before it."""
    return [(kind, text) for kind, text in (line.split("\t") for line in file.read_text("utf-8").splitlines())]


@dataclass(frozen=True, slots=True)
class Graded:
    """A text with grades of replies to it."""

    before: str
    said: str
    """The agent's answer to the text before."""
    text: str
    grades: list[tuple[int, int]]
    """Pairs of a reply's number and its grade, 0 to 2."""


def graded_in(files: Sequence[Path]) -> list[Graded]:
    """Return the graded texts of some files."""
    found: list[Graded] = []
    for line in (line for file in files for line in file.read_text("utf-8").splitlines()):
        before, said, text, grades = line.split("\t")
        pairs = (grade.split(":") for grade in grades.split())
        found.append(Graded(before, said, text, [(int(number), int(grade)) for number, grade in pairs]))
    return found


def network(torch: Any, kinds: Sequence[str], replies: Sequence[tuple[str, str]]) -> Any:
    """Return a new network: upper layers of the sentence model, a layer for the kinds, and two vectors for each reply.

    The product of such a vector with one for the text is a logit. It stands for the probability that the reply is at least
    acceptable, or good. A reply's vectors are made of its meaning, its kind, and a part of its own. During the training,
    half of these parts are missing each time, so that the network does not learn single replies by heart.
    """
    nn = torch.nn
    meanings = torch.from_numpy(Encoder().encode([text for _, text in replies]))
    kind_of = torch.tensor([kinds.index(kind) for kind, _ in replies])

    class Network(nn.Module):  # type: ignore[misc, name-defined]
        def __init__(self) -> None:
            super().__init__()
            self.upper, self.mark = upper_layers(torch, FIRST), nn.Embedding(1 + SAID, WIDTH)
            self.drop, self.weight = nn.Dropout(DROPOUT), nn.Linear(WIDTH, 1)
            self.kinds, self.wanted = nn.Linear(3 * WIDTH, len(kinds)), nn.Linear(3 * WIDTH, 2 * SIZE)
            self.meaning, self.kind = nn.Linear(WIDTH, 2 * SIZE), nn.Embedding(len(kinds), 2 * SIZE)
            self.own, self.general = nn.Embedding(len(replies), 2 * SIZE), nn.Embedding(len(replies), 2)
            self.likely = nn.Parameter(torch.full((2,), 0.5))
            for part, spread in ((self.mark, 0.02), (self.kind, 0.05), (self.own, 0.02), (self.general, 0.0)):
                nn.init.normal_(part.weight, 0, spread)

        def read(self, vectors: Any, marks: Any, lengths: Any) -> Any:
            """Return the first vector of the text, a weighted mean, and the mean, without the texts before it."""
            padding = None if lengths is None else torch.arange(marks.shape[1])[None] >= lengths[:, None]
            outside = marks >= EARLIER if padding is None else (marks >= EARLIER) | padding
            tokens = self.upper(vectors[..., PLACE * WIDTH : (PLACE + 1) * WIDTH] + self.mark(marks), padding).float()
            inside = (~outside).float()
            first = tokens[torch.arange(len(tokens)), inside.argmax(1)]
            weights = self.weight(tokens)[..., 0].masked_fill(outside, -1e9).softmax(1)
            mean = (tokens * inside[..., None]).sum(1) / inside.sum(1, keepdim=True)
            return self.drop(torch.cat([first, (tokens * weights[..., None]).sum(1), mean], 1))

        def replies(self) -> tuple[Any, Any]:
            """Return the vectors of the replies, and how good each is in general."""
            kept = (torch.rand(len(replies), 1) < 0.5).float() if self.training else 1.0
            given = self.meaning(meanings) + self.own.weight * kept + self.kind(kind_of)
            return given.view(-1, 2, SIZE), self.general.weight * kept

        def fix(self) -> None:
            """Compute the vectors of the replies now, because they no longer change."""
            given, general = (one.detach() for one in self.replies())
            self.replies = lambda: (given, general)  # type: ignore[method-assign]

        def forward(self, vectors: Any, marks: Any, lengths: Any = None) -> Any:
            read = self.read(vectors, marks, lengths)
            chances = self.kinds(read).log_softmax(1)
            given, general = self.replies()
            wanted = self.wanted(read).view(-1, 2, SIZE)
            found = torch.stack([wanted[:, at] @ given[:, at].T for at in (0, 1)], 2) / SIZE**0.5
            found = found + general + (chances[:, kind_of, None] + 3) * self.likely
            return (found.sigmoid().sum(2), chances[:, kind_of].exp()) if lengths is None else (chances, found)

    return Network()


def loss(torch: Any, made: Any, batch: Sequence[Row], wrong: dict[Row, list[int]], grades: dict[Row, Any]) -> Any:
    """Return the loss of the kinds and of the grades.

    The loss of the kinds is the cross-entropy of the right ones, plus a penalty for the probability of the wrong ones. A
    graded text teaches no kinds. Otherwise, the network would learn to trust the kinds that it knows by heart. The loss
    of the grades has a part for each grade, and a part for the choice of the best reply.
    """
    tools = torch.nn.functional
    with torch.autocast("cpu", torch.bfloat16):
        chances, found = (one.float() for one in made(*padded(torch, batch, noisy=False)))
    count = chances.shape[1]
    right, false = torch.zeros(len(batch), count), torch.zeros(len(batch), count)
    for number, row in enumerate(batch):
        for kind, share in zip(row.classes, SHARES, strict=False):
            right[number, kind] = share / sum(SHARES[: len(row.classes)])
        false[number, wrong.get(row, [])] = 1
    taught = torch.tensor([float(row not in grades) for row in batch])
    hits = -((right * (1 - SPREAD) + SPREAD / count) * chances).sum(1)
    misses = -(torch.log1p(-chances.exp().clamp(max=0.999)) * false).sum(1)
    total = (taught * (hits + WRONG * misses)).mean()
    for number, row in enumerate(batch):
        if row not in grades:
            continue
        replies, marks = torch.tensor(grades[row]).T
        reached = torch.stack([marks >= 1, marks >= 2], 1).float()
        logits = found[number, replies]
        lost = GRADES * tools.binary_cross_entropy_with_logits(logits, reached, reduction="sum")
        if marks.max() > marks.min():
            best = (marks == marks.max()).float()
            lost = lost - BEST * ((SHARP * logits.sigmoid().sum(1)).log_softmax(0) * best).sum() / best.sum()
        total = total + lost / len(batch)
    return total


def main(arguments: Sequence[str]) -> int:
    """Train and write, or check; return the exit code."""
    files, marked = sorted(HERE.glob("*.tsv")), sorted(GRADED.glob("grades*.tsv"))
    sources = [*files, *marked, GRADED / "replies.tsv"]
    if "--check" in arguments:
        return checked(OUT, sources, "python tools/networks/responses.py")
    import torch

    torch.manual_seed(0)
    load_lexicon()
    known, replies, graded = texts_in(files), replies_in(GRADED / "replies.tsv"), graded_in(marked)
    kinds = sorted({kind for kind, _ in replies})
    row_of = cache(lambda text: Row(normalise(text).unguessed, longest=64))
    grades: dict[Row, list[tuple[int, int]]] = {}
    for one in graded:
        row = Row(normalise(one.text).unguessed, longest=64)
        row.before, row.said = row_of(one.before) if one.before else None, Row(one.said) if one.said else None
        grades[row] = one.grades
    rows, wrong, graded_texts = list(grades), dict[Row, list[int]](), {one.text for one in graded}
    for text, (before, names) in known.items():
        if text in graded_texts:
            continue
        row = Row(normalise(text).unguessed, longest=64)
        row.before = row_of(before) if before else None
        row.classes = [kinds.index(name) for name in names if name in kinds]
        wrong[row] = [kinds.index(name[1:]) for name in names if name[1:] in kinds and name.startswith("!")]
        rows.append(row)
    print(f"{len(rows)} texts, {sum(map(len, grades.values()))} grades of {len(replies)} replies", flush=True)
    made = network(torch, kinds, replies)
    made = trained(
        torch,
        made,
        rows,
        lambda made, batch: loss(torch, made, batch, wrong, grades),
        EPOCHS,
        BATCH,
        RATE,
        list(made.upper.parameters()),
    )
    made.fix()
    about = {
        "labels": ";".join(text for _, text in replies),
        "kinds": ";".join(kind for kind, _ in replies),
        "sentences": digest(sources),
        "before": "1",
        "said": "1",
    }
    write(torch, made, OUT, len(LAYERS[BUNDLED]), ["grades", "likely"], about)
    return 0


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
