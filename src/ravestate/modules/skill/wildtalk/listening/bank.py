"""The bank: thousands of single utterances with replies. The listener says a reply of the utterance that resembles most.

Each line of bank/*.tsv has three columns: the tone (``sad``, ``angry``, ``glad``, ``tired`` or ``-``), utterances, and
replies; a bar separates the alternatives in a column. Replies may have roles, such as ``{they}``.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from importlib.resources import files

from ravestate.errors import DeclarationError
from ravestate.language.nearest import Nearest

from .moment import Line, Moment, roles_in

TONES = ("sad", "angry", "glad", "tired")
DARK = ("sad", "angry", "tired")


@dataclass(frozen=True, slots=True)
class Found:
    """An entry of the bank that resembles an utterance."""

    score: float
    """The similarity, 1 for equal sentences."""
    moment: Moment
    text: str
    """The sentence of the utterance."""


class Bank:
    """All pairs. Immutable but for the index, which `load` fills."""

    def __init__(self, rows: Sequence[tuple[str, str]]) -> None:
        """Take rows of a file: its name with the line's number, and the line."""
        self.moments: list[Moment] = []
        """The entries. The name of each is its place: file and line."""
        examples: list[str] = []
        self._of: list[int] = []
        for place, row in rows:
            moment = _moment(place, row)
            examples += moment.examples
            self._of += [len(self.moments)] * len(moment.examples)
            self.moments.append(moment)
        self.index = Nearest(examples)

    def similar(self, sentences: Sequence[str], most: int = 8) -> list[Found]:
        """Return the entries that resemble one of the sentences, the most similar first, each once."""
        found: dict[str, Found] = {}
        for near in self.index.nearest(sentences, most):
            moment = self.moments[self._of[near.place]]
            found.setdefault(moment.name, Found(near.score, moment, near.text))
        return list(found.values())


def read_bank() -> Bank:
    """Return the built-in bank."""
    folder = files(__package__ or "") / "bank"
    rows: list[tuple[str, str]] = []
    for file in sorted(folder.iterdir(), key=lambda file: file.name):
        if file.name.endswith(".tsv"):
            lines = file.read_text(encoding="utf-8").splitlines()
            rows += [(f"{file.name}:{number}", line) for number, line in enumerate(lines, 1) if line.strip()]
    return Bank(rows)


def _moment(place: str, row: str) -> Moment:
    columns = row.split("\t")
    if len(columns) != 3 or columns[0] not in (*TONES, "-"):
        raise DeclarationError(
            f"{place}: a line needs a tone ({', '.join(TONES)} or -), utterances and replies: {row!r}"
        )
    tone, said, replies = columns
    if not all(text.strip() for text in (*said.split("|"), *replies.split("|"))):
        raise DeclarationError(f"{place}: an utterance or a reply is empty: {row!r}")
    lines = tuple(Line(text.strip(), roles_in(text)) for text in replies.split("|"))
    return Moment(place, {"say": lines}, "" if tone == "-" else tone, examples=tuple(map(str.strip, said.split("|"))))
