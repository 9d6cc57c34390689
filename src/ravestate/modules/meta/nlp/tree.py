"""A text as a dependency tree: plain records, so that the rules need no spaCy."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

__all__ = ["Tree", "Word"]


@dataclass(frozen=True, slots=True)
class Word:
    """A token and its place in the tree. The labels are those of spaCy's English pipelines."""

    index: int
    """Its number within the tree."""
    text: str
    """As written."""
    lemma: str
    """Its dictionary form."""
    pos: str
    """Universal part of speech: ``NOUN``."""
    tag: str
    """Fine tag: ``NNS``."""
    dep: str
    """Its relation to its head: ``nsubj``; ``ROOT`` for a sentence's head."""
    head: int
    """The index of its head; a root is its own."""
    start: int
    """Where it begins, in characters of the text."""

    @property
    def low(self) -> str:
        """As written, in lower case and with straight apostrophes."""
        return self.text.lower().replace("’", "'")

    @property
    def end(self) -> int:
        """Where it ends, in characters of the text."""
        return self.start + len(self.text)


class Tree:
    """The words of a text, and who depends on whom."""

    def __init__(self, text: str, words: Sequence[Word]) -> None:
        """`words` are numbered from 0, in order."""
        self.text = text
        self.words = tuple(words)

    @cached_property
    def _children(self) -> list[list[Word]]:
        children: list[list[Word]] = [[] for _ in self.words]
        for word in self.words:
            if word.head != word.index:
                children[word.head].append(word)
        return children

    def children(self, word: Word, *deps: str) -> list[Word]:
        """The words that depend on `word` directly, in order; only those with one of `deps`, if any are given."""
        children = self._children[word.index]
        return [child for child in children if child.dep in deps] if deps else children

    def head(self, word: Word) -> Word:
        """The word that `word` depends on; a root is its own head."""
        return self.words[word.head]

    def ancestors(self, word: Word) -> Iterator[Word]:
        """The heads above `word`, nearest first."""
        while word.head != word.index:
            word = self.words[word.head]
            yield word

    def subtree(self, word: Word) -> list[Word]:
        """`word` and all that depends on it, in order."""
        found = [word]
        for known in found:  # grows while it is walked
            found += self._children[known.index]
        return sorted(found, key=lambda word: word.index)

    def before(self, word: Word) -> Word | None:
        """The word that stands before `word`."""
        return self.words[word.index - 1] if word.index else None

    def after(self, word: Word) -> Word | None:
        """The word that stands after `word`."""
        return self.words[word.index + 1] if word.index + 1 < len(self.words) else None

    def phrase(self, words: Iterable[Word]) -> str:
        """`words` as written, in order, with a space wherever the text has one or a word is left out."""
        written = ""
        last: Word | None = None
        for word in sorted(words, key=lambda word: word.index):
            if last is not None and (word.index != last.index + 1 or word.start > last.end):
                written += " "
            written += word.text
            last = word
        return written
