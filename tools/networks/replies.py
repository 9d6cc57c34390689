"""The head that grades the replies of small talk: ``replies`` (grades) and ``likely`` (probabilities of their kinds).

It learns two things: the kinds of reply that suit a text (``responses/*.tsv``), and the grades that readers gave to single
replies (``responses/graded``).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

from rows import WIDTH, Row
from trunk import Read, pool

from ravestate.language.encoder import Encoder
from ravestate.language.normal import normalise

HERE = Path(__file__).parent / "responses"
GRADED = HERE / "graded"
MARKED = sorted(GRADED.glob("grades*.tsv"))
SIZE = 96
"""The length of the two vectors that stand for a reply."""
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


class Replies:
    """The texts with kinds, and the texts with grades."""

    files: Sequence[Path] = [*sorted(HERE.glob("*.tsv")), *MARKED, GRADED / "replies.tsv"]

    def __init__(self) -> None:
        """Read the texts."""
        self.replies = replies_in(GRADED / "replies.tsv")
        self.kinds = sorted({kind for kind, _ in self.replies})
        self.labels = {
            "replies": [text for _, text in self.replies],
            "reply_kinds": [kind for kind, _ in self.replies],
        }
        row_of = cache(lambda text: Row(normalise(text).unguessed))
        self.rows = list[Row]()
        graded = graded_in(MARKED)
        for one in graded:
            row = Row(normalise(one.text).unguessed)
            row.before, row.said = row_of(one.before) if one.before else None, Row(one.said) if one.said else None
            row.grades = one.grades
            self.rows.append(row)
        texts = {one.text for one in graded}
        for text, (before, names) in texts_in(sorted(HERE.glob("*.tsv"))).items():
            if text in texts:
                continue
            row = Row(normalise(text).unguessed)
            row.before = row_of(before) if before else None
            row.classes = [self.kinds.index(name) for name in names if name in self.kinds]
            row.wrong = [
                self.kinds.index(name[1:]) for name in names if name.startswith("!") and name[1:] in self.kinds
            ]
            self.rows.append(row)
        for row in self.rows:
            row.head = "replies"

    def head(self, torch: Any) -> Any:
        """Return a new head: a layer for the kinds, and two vectors for each reply.

        The product of such a vector with one for the text is a logit. It stands for the probability that the reply is
        at least acceptable, or good. A reply's vectors are made of its meaning, its kind, and a part of its own. During
        the training, half of these parts are missing each time, so that the network does not learn single replies by
        heart.
        """
        nn, kinds, count = torch.nn, self.kinds, len(self.replies)
        meanings = torch.from_numpy(Encoder().encode([text for _, text in self.replies]))
        kind_of = torch.tensor([kinds.index(kind) for kind, _ in self.replies])

        class Head(nn.Module):  # type: ignore[misc, name-defined]
            def __init__(self) -> None:
                super().__init__()
                self.pool = pool(torch)
                self.kinds, self.wanted = nn.Linear(3 * WIDTH, len(kinds)), nn.Linear(3 * WIDTH, 2 * SIZE)
                self.meaning, self.kind = nn.Linear(WIDTH, 2 * SIZE), nn.Embedding(len(kinds), 2 * SIZE)
                self.own, self.general = nn.Embedding(count, 2 * SIZE), nn.Embedding(count, 2)
                self.likely = nn.Parameter(torch.full((2,), 0.5))
                for part, spread in ((self.kind, 0.05), (self.own, 0.02), (self.general, 0.0)):
                    nn.init.normal_(part.weight, 0, spread)

            def replies(self) -> tuple[Any, Any]:
                """Return the vectors of the replies, and how good each is in general."""
                kept = (torch.rand(count, 1) < 0.5).float() if self.training else 1.0
                given = self.meaning(meanings) + self.own.weight * kept + self.kind(kind_of)
                return given.view(-1, 2, SIZE), self.general.weight * kept

            def fix(self) -> None:
                """Compute the vectors of the replies now, because they no longer change."""
                given, general = (one.detach() for one in self.replies())
                self.replies = lambda: (given, general)  # type: ignore[method-assign]

            def found(self, read: Read) -> tuple[Any, Any]:
                """Return the logarithms of the kinds' probabilities, and the logits of the replies."""
                text = self.pool(read)
                chances = self.kinds(text).log_softmax(1)
                given, general = self.replies()
                wanted = self.wanted(text).view(-1, 2, SIZE)
                logits = torch.stack([wanted[:, at] @ given[:, at].T for at in (0, 1)], 2) / SIZE**0.5
                return chances, logits + general + (chances[:, kind_of, None] + 3) * self.likely

            def outputs(self, read: Read) -> dict[str, Any]:
                chances, logits = self.found(read)
                return {"replies": logits.sigmoid().sum(2), "likely": chances[:, kind_of].exp()}

            def loss(self, read: Read, batch: Sequence[Row]) -> Any:
                """Return the loss of the kinds and of the grades.

                The loss of the kinds is the cross-entropy of the right ones, plus a penalty for the probability of the
                wrong ones. A graded text teaches no kinds. Otherwise, the network would learn to trust the kinds that it
                knows by heart. The loss of the grades has a part for each grade, and a part for the choice of the best
                reply.
                """
                chances, found = self.found(read)
                right, false = torch.zeros(chances.shape), torch.zeros(chances.shape)
                for number, row in enumerate(batch):
                    for kind, share in zip(row.classes, SHARES, strict=False):
                        right[number, kind] = share / sum(SHARES[: len(row.classes)])
                    false[number, row.wrong] = 1
                taught = torch.tensor([float(not row.grades) for row in batch])
                hits = -((right * (1 - SPREAD) + SPREAD / len(kinds)) * chances).sum(1)
                misses = -(torch.log1p(-chances.exp().clamp(max=0.999)) * false).sum(1)
                total = (taught * (hits + WRONG * misses)).mean()
                for number, row in enumerate(batch):
                    if not row.grades:
                        continue
                    replies, marks = torch.tensor(row.grades).T
                    reached = torch.stack([marks >= 1, marks >= 2], 1).float()
                    logits = found[number, replies]
                    tools = nn.functional
                    lost = GRADES * tools.binary_cross_entropy_with_logits(logits, reached, reduction="sum")
                    if marks.max() > marks.min():
                        best = (marks == marks.max()).float()
                        chosen = (SHARP * logits.sigmoid().sum(1)).log_softmax(0)
                        lost = lost - BEST * (chosen * best).sum() / best.sum()
                    total = total + lost / len(batch)
                return total

        return Head()
