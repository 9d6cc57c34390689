"""The bank: thousands of single utterances with replies. The listener says a reply of the entry that suits best.

Each line of bank/*.tsv has three columns: the tone (``sad``, ``angry``, ``glad``, ``tired`` or ``-``), utterances, and
replies; a bar separates the alternatives in a column. Replies may have roles, such as ``{they}``.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from importlib.resources import files

from ravestate.errors import DeclarationError
from ravestate.language.nearest import Near, Nearest
from ravestate.language.normal import plain
from ravestate.language.reranker import Reranker

from .moment import Line, Moment, roles_in
from .suitability import Evidence

LEAST = 0.74
"""The least similarity at which an entry is looked at more closely."""
CLOSE, DOUBTFUL, PROBABLE = 0.93, 0.3, 0.57
"""An entry with the similarity `CLOSE` and the probability `DOUBTFUL`, or more, gets at least the probability `PROBABLE`:
more than half of such entries suit. Their other sentences may be far from the utterance, which lowers the estimate."""
ANSWER, EXACTLY = -10.6, -9.5
"""The least scores (logits) of an answer: of advice, which is right for many questions, and of what must be exact. An answer to
another question from the same area of life scores about -11."""
TONES = ("sad", "angry", "glad", "tired")
DARK = ("sad", "angry", "tired")


@dataclass(frozen=True, slots=True)
class Found:
    """An entry of the bank that resembles an utterance."""

    fit: float
    """The probability that its replies suit the utterance."""
    score: float
    """The similarity of the sentences, 1 for equal ones."""
    moment: Moment
    text: str
    """The sentence of the utterance that the entry resembles."""


class Bank:
    """All entries. Immutable, except that `load` fills the index."""

    def __init__(self, rows: Sequence[tuple[str, str]]) -> None:
        """Make the entries from `rows`: for each, a place (the file's name and the line's number) and the line."""
        self.moments: list[Moment] = []
        """The entries. The name of each is its place: file and line."""
        examples: list[str] = []
        self._of: list[int] = []
        self._places: list[range] = []
        for place, row in rows:
            moment = _moment(place, row)
            self._places.append(range(len(examples), len(examples) + len(moment.examples)))
            examples += moment.examples
            self._of += [len(self.moments)] * len(moment.examples)
            self.moments.append(moment)
        self.index = Nearest(examples)
        self._judge = Reranker()
        self._ranked = lru_cache(64)(self._rank)  # several rules ask about the same utterance

    def load(self) -> None:
        """Load the models now. Before that, `similar` finds only sentences that equal an example.

        Raises:
            PlatformError: A model is missing or broken.
        """
        self._judge.load()
        self.index.load()

    def answering(self, question: str, lines: Sequence[Line], least: float = ANSWER) -> list[Line]:
        """Return the lines that may answer a question, the likeliest first. Before `load`, return all, in their order."""
        if not self.index.loaded or not lines:
            return list(lines)
        scores = self._judge.score_pairs([(question, line.text) for line in lines]).tolist()
        ranked = sorted(zip(scores, lines, strict=True), key=lambda one: -one[0])
        return [line for score, line in ranked if score >= least]

    def similar(self, sentences: Sequence[str], utterance: str, most: int = 5) -> list[Found]:
        """Return the entries that resemble a sentence of an utterance, the most suitable first. No entry comes twice."""
        return list(self._ranked(tuple(sentences), utterance, most, self.index.loaded))

    def _rank(self, sentences: tuple[str, ...], utterance: str, most: int, _loaded: bool) -> tuple[Found, ...]:
        found: dict[int, Near] = {}
        for near in self.index.nearest(sentences, 2 * most):
            if near.score >= LEAST and len(found) < most:
                found.setdefault(self._of[near.place], near)
        fits = self._fits(list(found.items()), utterance)
        ranked = [
            Found(fit, near.score, self.moments[place], near.text)
            for (place, near), fit in zip(found.items(), fits, strict=True)
        ]
        return tuple(sorted(ranked, key=lambda one: -one.fit))

    def _fits(self, found: Sequence[tuple[int, Near]], utterance: str) -> list[float]:
        if not self.index.loaded:
            return [1.0] * len(found)  # their words are equal
        pairs = [(text, utterance) for place, _ in found for text in self.moments[place].examples]
        scores = iter(self._judge.score_pairs(pairs).tolist())
        meanings = iter(self.index.similarities(utterance, [at for place, _ in found for at in self._places[place]]))
        whole = plain(utterance)
        fits: list[float] = []
        for place, near in found:
            texts = self.moments[place].examples
            lengths = [len(text.split()) for text in texts]
            evidence = Evidence([next(scores) for _ in texts], [next(meanings) for _ in texts], lengths)
            fit = 1.0 if any(plain(text) == whole for text in texts) else evidence.probability()
            fits.append(max(fit, PROBABLE) if near.score >= CLOSE and fit >= DOUBTFUL else fit)
        return fits


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
