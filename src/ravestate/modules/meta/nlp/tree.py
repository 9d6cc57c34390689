"""The dependency tree of a text. It consists of plain records, and is independent of spaCy."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

SUBJECTS = ("nsubj", "nsubjpass", "csubj", "csubjpass")


@dataclass(frozen=True, slots=True)
class Word:
    """A token in the tree. Its labels are those of spaCy's English pipelines."""

    index: int
    """The word's index in the tree; the first word has the index 0."""
    text: str
    """The word as written."""
    lemma: str
    """The word's dictionary form."""
    pos: str
    """The word's universal part of speech, for example ``NOUN``."""
    tag: str
    """The word's detailed part of speech, for example ``NNS`` for a plural noun."""
    dep: str
    """The word's relation to its head, for example ``nsubj``. It is ``ROOT`` for a root, which has no head above it."""
    head: int
    """The index of the word's head, on which the word depends. A root is its own head."""
    start: int
    """The position of the word's first character in the text."""

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
        """Take the words of a text, in order. The index of the first word is 0."""
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
        """Return the words that depend directly on `word`, in text order; with `deps`, only words with one of these relations."""
        children = self._children[word.index]
        return [child for child in children if child.dep in deps] if deps else children

    def children_of(self, heads: Iterable[Word], *deps: str) -> list[Word]:
        """Return the words that depend directly on one of `heads`; with `deps`, only words with one of these relations."""
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
        """Return `word` and all words below it in the tree, in text order."""
        found = [word]
        for known in found:  # the list grows in the loop
            found += self._children[known.index]
        return sorted(found, key=lambda word: word.index)

    def before(self, word: Word) -> Word | None:
        """Return the word before `word` in the text; None if `word` is the first."""
        return self.words[word.index - 1] if word.index else None

    def after(self, word: Word) -> Word | None:
        """Return the word after `word` in the text; None if `word` is the last."""
        return self.words[word.index + 1] if word.index + 1 < len(self.words) else None

    def phrase(self, words: Iterable[Word]) -> str:
        """Return `words` as written, in text order. A single space replaces any text between two of them."""
        written = ""
        last: Word | None = None
        for word in sorted(words, key=lambda word: word.index):
            if last is not None and (word.index != last.index + 1 or word.start > last.end):
                written += " "
            written += word.text
            last = word
        return written


def is_tree(words: Sequence[Word]) -> bool:
    """Return whether the heads above each word lead to a root, without a loop.

    Two repairs of one sentence may contradict each other and make a loop. The time is linear in the number of words.
    """
    rooted: set[int] = set()
    for word in words:
        path: set[int] = set()
        while word.index not in rooted and word.head != word.index:
            if word.index in path:
                return False
            path.add(word.index)
            word = words[word.head]
        rooted |= path | {word.index}
    return True
