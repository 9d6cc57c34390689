"""The bank: thousands of utterances with replies. The listener says a reply of the most suitable entry.

Each line of bank/*.tsv has three columns: the tone (``sad``, ``angry``, ``glad``, ``tired`` or ``-``), utterances, and
replies; a bar separates the alternatives in a column. Replies may have roles, such as ``{they}``.

A line with ``>`` instead of a tone is a *follow-up*. It belongs to the nearest earlier line with one mark fewer, and
applies only after a reply of that line. There are three levels. Lines with ``#`` are comments.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from importlib.resources import files

from ravestate.errors import DeclarationError
from ravestate.language.nearest import Near, Nearest
from ravestate.language.normal import plain
from ravestate.language.reranker import Reranker

from .moment import Line, Moment, roles_in
from .suitability import Evidence

LEAST = 0.74
"""The minimum similarity at which the bank computes the probability that an entry suits."""
CLOSE, DOUBTFUL, PROBABLE = 0.93, 0.25, 0.47
"""If the similarity is at least `CLOSE` and the probability at least `DOUBTFUL`, the probability is raised to `PROBABLE`.
More than half of such entries suit: if their other sentences differ from the utterance, the estimate is too low."""
ANSWER, EXACTLY = -10.3, -8.6
"""The minimum scores (logits) of answers: of advice, which suits many questions, and of answers that must be exact. An
answer to another question from the same area of life scores -10 to -11."""
WORTH = 0.25
"""The minimum rough estimate of the probability at which the cross-encoder computes it exactly."""
MOST = 5
"""The maximum number of entries whose probability is computed."""
TONES = ("sad", "angry", "glad", "tired")
DEEPEST = 3
"""The greatest number of marks before a follow-up."""
REST = "*"
"""A follow-up with this utterance answers any other statement."""


@dataclass(frozen=True, slots=True)
class Found:
    """An entry of the bank that resembles an utterance."""

    fit: float
    """The probability that the entry's replies suit the utterance."""
    score: float
    """The similarity of the most similar sentences of both; 1 if they are equal."""
    moment: Moment
    text: str
    """The sentence of the utterance that the entry resembles."""


class Bank:
    """All entries. Immutable, except that `load` fills the index."""

    def __init__(self, rows: Sequence[tuple[str, str]]) -> None:
        """Make the entries. Each row has a place (the file's name and the line's number) and the text of the line."""
        self.moments = list(_entries([_row(place, row) for place, row in rows]))
        """The entries. The name of each is its place: file and line."""
        self.named = {one.name: one for entry in self.moments for one in _below(entry)}
        """The entries and their follow-ups, by name."""
        self._above = {one.name: entry.name for entry in self.named.values() for one in entry.follows}
        self._of = [place for place, one in enumerate(self.moments) for _ in one.examples]
        self._places: dict[str, range] = {}
        examples: list[str] = []
        later = [one for entry in self.moments for one in _below(entry) if one is not entry]
        for one in (*self.moments, *later):
            own = [text for text in one.examples if text != REST]
            self._places[one.name] = range(len(examples), len(examples) + len(own))
            examples += own
        self.index = Nearest(examples, searched=len(self._of))
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
        """Return the lines that may answer a question, the likeliest first. Before `load`, or if the question is empty,
        return all lines in the given order."""
        if not self.index.loaded or not lines or not question:
            return list(lines)
        scores = self._judge.score_pairs([(question, line.text) for line in lines]).tolist()
        ranked = sorted(zip(scores, lines, strict=True), key=lambda one: -one[0])
        return [line for score, line in ranked if score >= least]

    def similar(self, sentences: Sequence[str], utterance: str, *, roughly: bool = False) -> list[Found]:
        """Return the entries that resemble a sentence of an utterance, the most suitable first. No entry comes twice.

        With `roughly`, or if no entry is similar enough, the cross-encoder is not used. Then this takes about 5 ms, and
        up to 50 ms otherwise.
        """
        return list(self._ranked(tuple(sentences), utterance, roughly, self.index.loaded))

    def follow_ups(self, name: str) -> tuple[Moment, ...]:
        """Return the follow-ups of an entry or of a follow-up; none if the name is unknown."""
        return self.named[name].follows if name in self.named else ()

    def thread(self, name: str) -> Iterator[str]:
        """Yield a name, and the names of the entries above it, the nearest first."""
        while name:
            yield name
            name = self._above.get(name, "")

    def likeness(self, sentences: Sequence[str], follow_up: Moment) -> list[tuple[str, float]]:
        """Return the utterances of a follow-up, each with its similarity to the most similar of the sentences."""
        texts = [text for text in follow_up.examples if text != REST]
        return list(zip(texts, self.index.compared(sentences, self._places[follow_up.name]), strict=True))

    def _rank(self, sentences: tuple[str, ...], utterance: str, roughly: bool, _loaded: bool) -> tuple[Found, ...]:
        found: dict[int, Near] = {}
        for near in self.index.nearest(sentences, 2 * MOST):
            if near.score >= LEAST and len(found) < MOST:
                found.setdefault(self._of[near.place], near)
        fits = self._fits(list(found.items()), utterance, roughly)
        ranked = [
            Found(fit, near.score, self.moments[place], near.text)
            for (place, near), fit in zip(found.items(), fits, strict=True)
        ]
        return tuple(sorted(ranked, key=lambda one: -one.fit))

    def _fits(self, found: Sequence[tuple[int, Near]], utterance: str, roughly: bool) -> list[float]:
        if not self.index.loaded:
            return [1.0] * len(found)  # before `load`, only equal sentences are found
        groups = [self.moments[place].examples for place, _ in found]
        places = [at for place, _ in found for at in self._places[self.moments[place].name]]
        meanings = iter(self.index.similarities(utterance, places))
        evidence = [
            Evidence(near.score, [next(meanings) for _ in texts])
            for (_, near), texts in zip(found, groups, strict=True)
        ]
        worth = [not roughly and one.probability() >= WORTH for one in evidence]
        pairs = [(text, utterance) for texts, judged in zip(groups, worth, strict=True) if judged for text in texts]
        scores = iter(self._judge.score_pairs(pairs).tolist() if pairs else [])
        whole = plain(utterance)
        fits: list[float] = []
        for (_, near), texts, one, judged in zip(found, groups, evidence, worth, strict=True):
            known = replace(one, scores=[next(scores) for _ in texts]) if judged else one
            fit = 1.0 if any(plain(text) == whole for text in texts) else known.probability()
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
    return Bank([(place, row) for place, row in rows if not row.startswith("#")])


@dataclass(frozen=True, slots=True)
class _Row:
    """A line of a file."""

    place: str
    level: int
    tone: str
    examples: tuple[str, ...]
    lines: tuple[Line, ...]

    @property
    def file(self) -> str:
        """The name of the file."""
        return self.place.partition(":")[0]


def _row(place: str, row: str) -> _Row:
    columns = row.split("\t")
    level = len(columns[0]) if set(columns[0]) == {">"} else 0
    if len(columns) != 3 or (columns[0] not in (*TONES, "-") and not 0 < level <= DEEPEST):
        raise DeclarationError(
            f"{place}: a line needs a tone ({', '.join(TONES)}, -, or > to >>> for a follow-up), utterances and "
            f"replies: {row!r}"
        )
    tone, said, replies = columns
    if not all(text.strip() for text in (*said.split("|"), *replies.split("|"))):
        raise DeclarationError(f"{place}: an utterance or a reply is empty: {row!r}")
    lines = tuple(Line(text.strip(), roles_in(text)) for text in replies.split("|"))
    examples = tuple(map(str.strip, said.split("|")))
    if REST in examples and not level:
        raise DeclarationError(f"{place}: only a follow-up can have the utterance {REST}: {row!r}")
    return _Row(place, level, tone if tone in TONES else "", examples, lines)


def _entries(rows: Sequence[_Row], level: int = 0, tone: str = "") -> Iterator[Moment]:
    """Yield the entries of one level, each with its follow-ups, which have its tone."""
    if rows and rows[0].level > level:
        raise DeclarationError(f"{rows[0].place}: a follow-up needs an earlier line with one mark fewer")
    starts = [at for at, row in enumerate(rows) if row.level == level]
    for start, end in zip(starts, [*starts, len(rows)][1:], strict=True):
        row, below = rows[start], rows[start + 1 : end]
        foreign = next((one for one in below if one.file != row.file), None)
        if foreign is not None:
            raise DeclarationError(f"{foreign.place}: a file cannot begin with a follow-up")
        own = tone if level else row.tone
        follows = tuple(_entries(below, level + 1, own))
        yield Moment(row.place, {"say": row.lines}, own, examples=row.examples, follows=follows)


def _below(entry: Moment) -> Iterator[Moment]:
    """Yield an entry and all its follow-ups."""
    yield entry
    for one in entry.follows:
        yield from _below(one)
