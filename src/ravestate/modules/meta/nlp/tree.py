"""A text as a dependency tree of plain records, independent of spaCy."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

SUBJECTS = ("nsubj", "nsubjpass", "csubj", "csubjpass")


@dataclass(frozen=True, slots=True)
class Word:
    """A token in the tree, with the labels of spaCy's English pipelines."""

    index: int
    """The word's number within the tree."""
    text: str
    """The word as written."""
    lemma: str
    """Its dictionary form."""
    pos: str
    """The universal part of speech: ``NOUN``."""
    tag: str
    """The fine tag: ``NNS``."""
    dep: str
    """Its relation to its head: ``nsubj``; ``ROOT`` for the head of a sentence."""
    head: int
    """The index of its head; a root is its own head."""
    start: int
    """The position of its first character in the text."""

    @property
    def low(self) -> str:
        """The word in lower case, with straight apostrophes."""
        return self.text.lower().replace("’", "'")

    @property
    def end(self) -> int:
        """The position after the word's last character in the text."""
        return self.start + len(self.text)


class Tree:
    """The words of a text with their dependencies."""

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
        """Return the words that depend directly on `word`, in order; with `deps`, only those with such a relation."""
        children = self._children[word.index]
        return [child for child in children if child.dep in deps] if deps else children

    def children_of(self, heads: Iterable[Word], *deps: str) -> list[Word]:
        """Return the words that depend directly on one of `heads`; with `deps`, only those with such a relation."""
        return [child for head in heads for child in self.children(head, *deps)]

    def head(self, word: Word) -> Word:
        """Return the head of `word`; a root is its own head."""
        return self.words[word.head]

    def ancestors(self, word: Word) -> Iterator[Word]:
        """Yield the heads above `word`, nearest first."""
        while word.head != word.index:
            word = self.words[word.head]
            yield word

    def subtree(self, word: Word) -> list[Word]:
        """Return `word` and all of its dependents, in order."""
        found = [word]
        for known in found:  # the list grows in the loop
            found += self._children[known.index]
        return sorted(found, key=lambda word: word.index)

    def before(self, word: Word) -> Word | None:
        """Return the word before `word`."""
        return self.words[word.index - 1] if word.index else None

    def after(self, word: Word) -> Word | None:
        """Return the word after `word`."""
        return self.words[word.index + 1] if word.index + 1 < len(self.words) else None

    def phrase(self, words: Iterable[Word]) -> str:
        """Return `words` as written, in order. A gap becomes one space."""
        written = ""
        last: Word | None = None
        for word in sorted(words, key=lambda word: word.index):
            if last is not None and (word.index != last.index + 1 or word.start > last.end):
                written += " "
            written += word.text
            last = word
        return written
