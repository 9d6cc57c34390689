"""The steps from a question to an answer with a source and a confidence: retrieve, read, weigh.

The reader is a cross-encoder, which is a model that judges how well a passage answers a question.
"""

from __future__ import annotations

import math
import re
import threading
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from ravestate.language import Reranker
from ravestate.modules._text import printable
from ravestate.modules.meta.nlp import QuestionWord

from .confidence import confidence, in_talk
from .index import Found, Index
from .lexicon import lexicon, variants_of
from .passages import LONGEST
from .question import Parse, Question, as_question
from .shipped import OWN, bring_up
from .stems import Stems

RETRIEVED = 20
"""The maximum number of passages in each of two searches: for any word of the question, and for all its words."""
READ = (1, 1, 2, 4, 8, 8)
"""The sizes of the batches in which passages are read until one is good enough. The last two sizes are only for a
follow-up, which is a question that refers to earlier questions."""
GOOD, VERY_GOOD, HOPELESS = 7.5, 9.0, -4.0
"""The reading ends when the best score so far is at least `VERY_GOOD` after the first passage, or at least `GOOD` later.
If the best of four scores is `HOPELESS` or less, the reading also ends, except for a follow-up."""
ENOUGH = 0.4
"""The minimum share (0 to 1) of the question's words in a passage. Passages with a smaller share are not read,
except passages of documents that the thread is about (see `SHORT`)."""
SHORT = 24
"""The search adds at most this many passages of each document that the thread (the latest questions) is about. These
passages need not have words of the question."""
LEVEL = 0.8
"""Two scores count as equal if they differ by less than this."""
COMMON = 20_000
"""The first search (for any word) skips words that are in more passages than this, unless all words of the question are
so common."""
NAMES, KINDS = 0.4, 0.7
"""If a follow-up has only names, these values replace the share of its words in a passage: `KINDS` if the passage has a
word of `Question.kinds`, `NAMES` if not."""
WORDS = 24
"""The maximum number of words to search for."""
NOT_STATED = "no document states all of it"
"""The reason why there is no answer, if no passage has enough of the question's words and meets its qualifiers (names,
years, ranks...)."""


@dataclass(frozen=True, slots=True)
class Candidate:
    """A passage with its score from the reader."""

    text: str
    title: str
    row: int
    """The passage's row in the index."""
    score: float
    """The reader's score, up to 11; a higher score means a better answer."""
    covered: float
    """The share of the question's words in the passage, 0 to 1; rare words weigh more. In a follow-up, names do not count."""


@dataclass(frozen=True, slots=True)
class Answer:
    """An answer from the documents, or a computed result. If the text is empty, there is no answer."""

    question: str
    text: str = ""
    """A passage, word for word, or a computed result. A comparison has its result, and then both passages."""
    source: str = ""
    title: str = ""
    confidence: float = 0.0
    """The probability that the text is right, from 0 to 1."""
    candidates: tuple[Candidate, ...] = ()
    """All passages that were read, best first."""
    reason: str = ""
    """The reason why there is no text; empty if there is a text."""


def together(answers: Sequence[Answer]) -> Answer:
    """Return the answers to several questions of one utterance as one answer, with the lowest of their confidences.

    The answer names its sources only if each part comes from a document. Otherwise, a sentence that was
    written for Ravestate, or a computed result, would seem to come from one of the documents.
    """
    if len(answers) == 1:
        return answers[0]
    texts = dict.fromkeys(
        answer.text if answer.text.endswith((".", "!", "?")) else f"{answer.text}." for answer in answers
    )
    sources = dict.fromkeys(answer.source for answer in answers)
    unnamed = len(sources) > 1 and not {"", OWN}.isdisjoint(sources)
    return Answer(
        " ".join(answer.question for answer in answers),
        " ".join(texts),
        OWN if unnamed else " and ".join(sources),
        answers[0].title,
        min(answer.confidence for answer in answers),
        tuple(candidate for answer in answers for candidate in answer.candidates),
    )


class Answerer:
    """An index with a reader. It opens the index file at the first question, and again if the file is replaced.

    Thread-safe.

    Example:
        ::

            answer = Answerer(Path("index.sqlite")).answer("What is the capital of Peru?")
            answer.text, answer.source      # ('The capital of Peru is Lima.', 'The World Factbook, 2025')
    """

    def __init__(self, path: Path, *, collection: bool = True, reranker: Path | str | None = None) -> None:
        """Make an answerer; it opens and loads nothing yet.

        Args:
            path: The file of the index; a missing file is created.
            collection: Whether the index should contain the collection that comes with Ravestate.
            reranker: The folder of a reader to use instead of the bundled reader; see `Reranker`.
        """
        self._path = path
        self._collection = collection
        self._reranker = Reranker(reranker)
        self._opening = threading.Lock()
        self._index: Index | None = None
        self._stems: Stems | None = None

    def load(self) -> None:
        """Open the index, add the collection, and load the reader, unless this is done already.

        Without documents, the reader is not loaded. `answer` does the same, but loads the reader only if it has
        retrieved a passage.

        Raises:
            PlatformError: The index cannot be opened, or the reader is not installed.
        """
        if self._opened().size():
            self._reranker.load()

    def close(self) -> None:
        """Close the index."""
        with self._opening:
            if self._index is not None:
                self._index.close()
                self._index = None

    def answer(self, heard: str | Parse | Question, titles: Sequence[str] = ()) -> Answer:
        """Answer an utterance from the documents.

        Args:
            heard: The utterance, its parse, or its question.
            titles: The titles of documents that the thread (the latest questions) is about. The first passages of these
                documents are considered as well.

        Raises:
            PlatformError: See `load`.
        """
        question = (
            heard
            if isinstance(heard, Question)
            else as_question(heard if isinstance(heard, Parse) else printable(heard))
        )
        if question.declined:
            return Answer(question.text, reason=question.declined)
        index = self._opened()
        if not index.size():
            return Answer(question.text, reason="there are no documents")
        retrieved = self._retrieve(index, question, titles)
        if not retrieved:
            return Answer(question.text, reason=NOT_STATED)
        read = self._read(question, retrieved)
        best = read[0]
        return Answer(
            question.text, best.text, index.source(best.row), best.title, _chance(question, best), tuple(read)
        )

    def states(self, needs: Sequence[Sequence[str]]) -> bool:
        """Return whether one passage has at least one word of each group in `needs`, in less than a millisecond."""
        return not needs or bool(self._opened().search_all(needs, 1))

    def titled(self, name: str) -> str:
        """Return the title of a document about `name`, or "". Ignore case, and *the* at the beginning."""
        return self._opened().title_of(name)

    # ---------------------------------------------------------------------------------- internals

    def _opened(self) -> Index:
        with self._opening:
            if self._index is not None and not self._index.in_place():
                self._index.close()
                self._index = None
            if self._index is None:
                index = Index(self._path)
                try:
                    bring_up(index, wanted=self._collection)
                except BaseException:
                    index.close()
                    raise
                self._index = index
            if self._stems is None:
                self._stems = Stems()
            return self._index

    def _retrieve(self, index: Index, question: Question, titles: Sequence[str]) -> list[tuple[float, Found]]:
        """Return the passages that meet the qualifiers, each with its share of the question's words, best first."""
        assert self._stems is not None  # `_opened` has set it
        asked = [variants_of(word) for word in question.words[:WORDS]]
        searched = list(dict.fromkeys(word for group in (*asked, question.kinds[:WORDS]) for word in group))
        words = list(dict.fromkeys(word for group in (searched, *question.needs) for word in group))
        stem_of = {word: stems for word, stems in zip(words, self._stems(*words), strict=True) if stems}
        known = index.frequencies(sorted({stem for stems in stem_of.values() for stem in stems}))
        # An upper bound for the number of passages with each word.
        counts = {word: min(known.get(stem, 0) for stem in stems) for word, stems in stem_of.items()}

        searched = [word for word in searched if word in counts]
        rare = [word for word in searched if counts[word] <= COMMON]
        in_view = [each for title in titles for each in index.passages(title, SHORT)]
        found = [*in_view, *index.search(rare or searched, RETRIEVED, without=question.avoids)]
        # Many passages that repeat the rarest word may rank above a passage that has all words.
        found = list(dict.fromkeys([*found, *index.search_all(asked, RETRIEVED, without=question.avoids)]))

        size = index.size()
        weights: list[tuple[tuple[str, ...], float]] = []
        for word, forms in zip(question.words, asked, strict=False):
            often = max((counts[form] for form in forms if form in counts), default=None)
            if often is not None and not (question.follows and word.lower() in question.given):
                weights.append((forms, math.log1p(size / (often + 0.5))))
        total = sum(weight for _, weight in weights)
        avoided = {stem for stems in self._stems(*question.avoids) for stem in stems}
        counted = variants_of(question.counted.lower()) if question.counted else ()
        retrieved: list[tuple[float, Found]] = []
        stems_of = self._stems(*(f"{each.title} {each.text} {each.hints}" for each in found))
        for each, have in zip(found, map(set, stems_of), strict=True):

            def has(forms: Iterable[str], have: set[str] = have) -> bool:
                return any(have.issuperset(stem_of[form]) for form in forms if form in stem_of)

            covered = KINDS if has(question.kinds) else NAMES
            if total:
                covered = sum(weight for forms, weight in weights if has(forms)) / total
            if (
                (covered >= ENOUGH or not total or each in in_view)
                and have.isdisjoint(avoided)
                and all(map(has, question.needs))
                and _can_answer(question, each)
                and (not counted or any(form in each.text.lower() for form in counted))
            ):
                retrieved.append((covered, each))
        # If passages have equal shares, plain passages (`_is_plain`) come first. The sort is stable, so apart from
        # that, they stay in the order of BM25.
        return sorted(retrieved, key=lambda each: (-each[0], not _is_plain(question, each[1].text)))

    def _read(self, question: Question, retrieved: Sequence[tuple[float, Found]]) -> list[Candidate]:
        read: list[Candidate] = []
        best = 0.0
        for count in READ if question.follows else READ[:4]:
            batch = retrieved[len(read) : len(read) + count]
            if not batch or best >= (GOOD if len(read) > 1 else VERY_GOOD):
                break
            if best <= HOPELESS and len(read) > 2 and not question.follows:
                break
            scores = self._reranker.score(question.text, [_readable(found) for _, found in batch])
            read += [
                Candidate(found.text, found.title, found.row, float(score), covered)
                for (covered, found), score in zip(batch, scores, strict=True)
            ]
            best = max(candidate.score for candidate in read)
        if question.follows:
            return sorted(read, key=lambda candidate: -_chance(question, candidate))
        read.sort(key=lambda candidate: -candidate.score)
        # Among equals, take a plain passage (`_is_plain`), and then the passage with the fewest words that the question
        # does not have. So the answer about life expectancy is not the passage about the life expectancy of women.
        level = [c for c in read if c.score > read[0].score - LEVEL and c.covered >= read[0].covered]
        asked = {form for word in question.words for form in variants_of(word.lower())}
        first = min(level, key=lambda one: (not _is_plain(question, one.text), _besides(one.text, asked)))
        return [first, *(c for c in read if c is not first)]


def _chance(question: Question, best: Candidate) -> float:
    return (in_talk if question.follows else confidence)(best.score, best.covered)


def _readable(found: Found) -> str:
    """Return a passage for the reader: with its title before it, unless the passage contains the title."""
    text = found.text if found.title.lower() in found.text.lower() else f"{found.title}: {found.text}"
    return text[:LONGEST]


_HOW_MANY = re.compile(r"\bhow (?:many|much) ")
_INNER_WORD = re.compile(r"(?<=[^.!?] )[^\W\d_][^\W_]+")
"""A word that does not begin a sentence. If it has a capital letter, it is a name."""


@cache
def _any_of(name: str) -> re.Pattern[str]:
    """Return a pattern for any of the words and patterns of a list in ``words.yaml``."""
    return re.compile(rf"\b(?:{'|'.join(lexicon()['answers'][name].split())})\b", re.IGNORECASE)


def _can_answer(question: Question, found: Found) -> bool:
    """Return whether a passage has the kind of thing that the question asks for, such as a number or a place."""
    asked, kind = question.text.lower(), question.kind
    needed = ""
    if kind is QuestionWord.AMOUNT and _HOW_MANY.search(asked):
        needed = "number"
    elif kind is QuestionWord.YES_NO and asked.startswith(("is ", "are ", "was ", "were ")):
        needed = "being"
    elif kind is QuestionWord.REASON or asked.startswith(("what makes ", "what causes ", "what made ")):
        needed = "cause"
    elif "how old " in asked:
        needed = "age"
    elif asked.startswith(("how far is ", "how far are ", "how far away ")):
        needed = "distance"
    elif kind is QuestionWord.TIME:
        needed = "time"
    if needed:
        return _any_of(needed).search(found.text) is not None
    if asked.startswith("who is "):
        return _any_of("ended").search(found.text) is None
    does = kind is QuestionWord.PERSON and re.search(r"\bwho (?!is|was|are|were)", asked)
    if (does and " by " not in found.text) or (kind is QuestionWord.PLACE and "where" not in asked):
        names = [word for word in _INNER_WORD.findall(found.text) if word[0].isupper()]
        return any(name.lower() not in asked for name in (*names, *found.title.split()))
    return True


_PLAIN = (QuestionWord.OBJECT, QuestionWord.FORM)
"""The kinds of questions whose answers begin with the subject."""
_WORLD = re.compile(r"\b(?:in|of) the world\b|\bon earth\b|\bof all\b", re.IGNORECASE)


def _is_plain(question: Question, text: str) -> bool:
    """Return whether a passage is about just what the question names.

    The passage must begin with the question's subject: *Clouds are made of droplets*, not *Cirrus clouds consist of ice*.
    For a question such as *what is the longest river*, the passage must instead mention the whole world.
    """
    asked = question.text.lower()
    ranked = any(word.endswith("est") or word == "most" for group in question.needs for word in group)
    if ranked and not _WORLD.search(asked):
        return _WORLD.search(text) is not None
    first = re.escape(question.words[0]) if question.words and question.kind in _PLAIN else ""
    return bool(first) and re.match(rf"(?:an? |the )?{first} (?!about\b)", text, re.IGNORECASE) is not None


def _besides(text: str, asked: set[str]) -> int:
    """Return the number of words of `text`, outside brackets, that are not in `asked`."""
    return len(set(re.findall(r"[a-z]{2,}", re.sub(r"\([^)]*\)", "", text.lower()))) - asked)
