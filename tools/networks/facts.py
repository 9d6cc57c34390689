"""The head that marks the values of facts in a text: ``facts`` and ``denials``."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from marks import Marked, Value, read
from rows import LAYERS, WIDTH, Row
from trunk import Read

from ravestate.language.network import SAID
from ravestate.language.normal import normalise
from ravestate.modules.skill.persqa.topics import TOPICS

LABELS = [*TOPICS, "favourite"]
HIDDEN, DROPOUT = 192, 0.3
"""The size of an LSTM layer in each direction, and its dropout."""
NOISE, LOST = 0.05, 0.05
"""The standard deviation of the noise on the vectors, and the share of tokens that are left out."""
SPREAD, DENIED = 0.05, 0.3
"""Label smoothing, and the weight of the denials in the loss."""


def row_of(sentence: Marked) -> Row:
    """Return a sentence in its normal form, with the vectors and classes of its tokens.

    Class 0 is *no value*. A label has two classes: 1 + 2 * label for the first token of a value, 2 + 2 * label for the
    others. `Row.denied` is 1 if the value is denied, 0 if it holds, -1 without a value.
    """
    normal = normalise(sentence.text)
    row = Row(normal.text, longest=96)
    row.classes, row.denied = [0] * len(row), [-1.0] * len(row)
    row.asked = LABELS.index(sentence.context) + 1 if sentence.context in LABELS else 0
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


class Facts:
    """The marked sentences."""

    files: Sequence[Path] = sorted((Path(__file__).parent / "facts").glob("*.txt"))

    def __init__(self) -> None:
        """Read the sentences."""
        self.rows = [row_of(one) for one in read(self.files)]
        self.labels = {"facts": LABELS}

    def head(self, torch: Any) -> Any:
        """Return a new head: two bidirectional LSTM layers that read a weighted mean of the sentence model's layers.

        It does not read the trunk, because the inner layers say more about single words. With the trunk alone, 88 % of
        the sentences in ``marked_rows.txt`` get exactly the right marks; with the layers alone, or with both, 91 %.
        """
        nn = torch.nn

        class Head(nn.Module):  # type: ignore[misc, name-defined]
            def __init__(self) -> None:
                super().__init__()
                self.weights = nn.Parameter(torch.zeros(LAYERS))
                self.norms = nn.ModuleList([nn.LayerNorm(WIDTH) for _ in range(LAYERS)])
                self.before, self.after = nn.LayerNorm(WIDTH), nn.LayerNorm(2 * HIDDEN)
                self.mark, self.asked = nn.Embedding(1 + SAID, WIDTH), nn.Embedding(1 + len(LABELS), WIDTH)
                for part in (self.mark, self.asked):
                    nn.init.normal_(part.weight, 0, 0.1)
                self.lstm = nn.LSTM(WIDTH, HIDDEN, 2, batch_first=True, bidirectional=True, dropout=DROPOUT)
                self.drop = nn.Dropout(DROPOUT)
                self.classes, self.denied = nn.Linear(2 * HIDDEN, 1 + 2 * len(LABELS)), nn.Linear(2 * HIDDEN, 1)

            def read(self, read: Read, lengths: Any = None) -> tuple[Any, Any]:
                """Return the logits of the classes and of the denials. Without `lengths`, there is no padding."""
                vectors = read.vectors
                if self.training:  # noise against overfitting
                    kept = (torch.rand(vectors.shape[:2]) > LOST)[..., None]
                    vectors = (vectors + torch.randn_like(vectors) * NOISE) * kept
                shares, parts = self.weights.softmax(0), vectors.split(WIDTH, dim=2)
                mixed = sum(shares[at] * self.norms[at](parts[at]) for at in range(LAYERS)) + self.mark(read.marks)
                tokens = self.drop(self.before(mixed) + self.asked(read.asked)[:, None])
                if lengths is None:
                    tokens = self.lstm(tokens)[0]
                else:
                    tools = nn.utils.rnn
                    packed = tools.pack_padded_sequence(tokens, lengths, batch_first=True, enforce_sorted=False)
                    tokens = tools.pad_packed_sequence(self.lstm(packed)[0], batch_first=True)[0]
                tokens = self.drop(self.after(tokens))
                return self.classes(tokens), self.denied(tokens)[..., 0]

            def outputs(self, read: Read) -> dict[str, Any]:
                classes, denied = self.read(read)
                return {"facts": classes.softmax(-1), "denials": denied.sigmoid()}

            def loss(self, read: Read, batch: Sequence[Row]) -> Any:
                """Return the cross-entropy of the classes and the denials of all tokens."""
                found, denials = self.read(read, torch.tensor([len(row) for row in batch]))
                longest = found.shape[1]
                classes = torch.tensor([row.classes + [-100] * (longest - len(row)) for row in batch])
                denied = torch.tensor([row.denied + [-1.0] * (longest - len(row)) for row in batch])
                total = nn.functional.cross_entropy(
                    found.flatten(0, 1), classes.flatten(), ignore_index=-100, label_smoothing=SPREAD
                )
                valued = denied >= 0
                if valued.any():
                    lost = nn.functional.binary_cross_entropy_with_logits(denials[valued], denied[valued])
                    total = total + DENIED * lost
                return total

        return Head()
