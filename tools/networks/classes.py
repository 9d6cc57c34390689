"""The heads that put a whole text into a class: ``answers``, ``kinds`` (of questions) and ``moves`` (of a listener)."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from ordinary import statements
from rows import WIDTH, Row
from trunk import Read, pool

from ravestate.language.examples import bundled
from ravestate.language.normal import normalise

HERE = Path(__file__).parent
HEADS = ("answers", "kinds", "moves")
TALKS = sorted((HERE / "responses").glob("*.tsv"))
FILES = {head: sorted((HERE / head).glob("*.tsv")) for head in HEADS}
SPREAD = 0.1
"""Label smoothing: the share of the target that is spread over all classes."""
LIKE = {
    "rejoice": "joy", "mourn": "grief", "console": "illness sadness loneliness worry failure anger tiredness",
    "thank": "thanks", "apologise": "insult contradiction not_meant", "explain": "repeat",
    "entertain": "joke song story play bored", "obey": "quiet stop", "introduce": "identify", "greet": "greeting",
    "farewell": "farewell",
}  # fmt: skip
"""A move → classes in ``acts.yaml`` and ``feelings.yaml`` whose examples it borrows."""
STEP, ORDINARY = 4, 0.6
"""One ordinary statement in STEP is read as a text without an answer, and has the weight ORDINARY."""
MOST, BORROWED = 25, 0.4
"""The maximum number of examples that a move borrows from a class, and their weight."""


def cases(files: Sequence[Path]) -> dict[str, str]:
    """Return the texts of some files, and the class of each."""
    lines = (line for file in files for line in file.read_text(encoding="utf-8").splitlines() if "\t" in line)
    return {text.strip(): name.strip() for text, name in (line.split("\t") for line in lines)}


class Classes:
    """The sentences of the three heads."""

    files: Sequence[Path] = [file for head in HEADS for file in FILES[head]]

    def __init__(self) -> None:
        """Read the sentences."""
        known = {head: cases(FILES[head]) for head in HEADS}
        self.labels = {head: sorted(set(known[head].values())) for head in HEADS}
        self.rows = [self._row(text, head, name) for head in HEADS for text, name in known[head].items()]
        for text in statements(TALKS)[::STEP]:
            self.rows.append(self._row(text, "answers", "-"))
            self.rows[-1].weight = ORDINARY
        others = {**bundled("acts").classes, **bundled("feelings").classes}
        for move, names in LIKE.items():
            for text in (text for name in names.split() for text in others[name][:MOST]):
                self.rows.append(self._row(text, "moves", move))
                self.rows[-1].weight = BORROWED

    def _row(self, text: str, head: str, name: str) -> Row:
        row = Row(normalise(text).unguessed)
        row.head, row.classes = head, [self.labels[head].index(name)]
        return row

    def head(self, torch: Any) -> Any:
        """Return a new head."""
        nn, labels = torch.nn, self.labels

        class Head(nn.Module):  # type: ignore[misc, name-defined]
            def __init__(self) -> None:
                super().__init__()
                self.pool = pool(torch)
                self.out = nn.ModuleDict({head: nn.Linear(3 * WIDTH, len(labels[head])) for head in HEADS})

            def outputs(self, read: Read) -> dict[str, Any]:
                text = self.pool(read)
                return {head: out(text).softmax(-1) for head, out in self.out.items()}

            def loss(self, read: Read, batch: Sequence[Row]) -> Any:
                """Return the weighted cross-entropy of the right classes."""
                text, total = self.pool(read), 0.0
                for head, out in self.out.items():
                    places = [place for place, row in enumerate(batch) if row.head == head]
                    if places:
                        right = torch.tensor([batch[place].classes[0] for place in places])
                        weights = torch.tensor([batch[place].weight for place in places])
                        lost = nn.functional.cross_entropy(
                            out(text[places]), right, label_smoothing=SPREAD, reduction="none"
                        )
                        total = total + (lost * weights).sum() / len(batch)
                return total

        return Head()
