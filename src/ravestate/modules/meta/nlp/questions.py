"""Find the single questions of an utterance. For example, *who are you and where am I* asks two."""

from __future__ import annotations

from collections.abc import Sequence

from .tree import Tree, Word

WH = ("WP", "WP$", "WDT", "WRB")
"""Tags of question words."""
FINITE = ("VBZ", "VBP", "VBD", "MD")
"""Tags of finite verbs."""
MOST = 8
"""The maximum number of questions of an utterance that are read one by one."""


def questions_in(tree: Tree) -> list[str]:
    """Return the questions of an utterance, if it asks several; otherwise an empty list."""
    texts: list[str] = []
    for sentence in asking(tree):
        clause: list[Word] = []
        for place, word in enumerate(sentence):
            if word.pos == "CCONJ" and is_finite(clause) and _opens(sentence[place + 1 :]):
                texts.append(f"{tree.phrase(clause).rstrip(' ,')}?")
                clause = []
            else:
                clause.append(word)
        texts.append(tree.phrase(clause))
    return texts[:MOST] if len(texts) > 1 else []


def asking(tree: Tree) -> list[list[Word]]:
    """Return the sentences with a question word or mark."""
    return [s for s in sentences_in(tree) if any(word.tag in WH for word in s) or s[-1].text.endswith("?")]


def sentences_in(tree: Tree) -> list[list[Word]]:
    """Return the words of each sentence."""
    return [tree.subtree(word) for word in tree.words if word.head == word.index and word.pos != "PUNCT"]


def is_finite(words: Sequence[Word]) -> bool:
    """Return whether words have a finite verb."""
    return any(word.tag in FINITE for word in words)


def _opens(words: Sequence[Word]) -> bool:
    """Return whether words are a clause that begins with a question word: *who wrote Hamlet*, *in which year was it*."""
    first = next((word for word in words if word.pos != "ADP"), None)
    return first is not None and first.tag in WH and is_finite(words)
