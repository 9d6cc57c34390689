"""Find the single questions of an utterance. For example, *who are you and where am I* asks two."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from ravestate.language.contractions import word_set

from .tree import SUBJECTS, Tree, Word

WH = ("WP", "WP$", "WDT", "WRB")
"""Tags of question words."""
FINITE = ("VBZ", "VBP", "VBD", "MD")
"""Tags of finite verbs."""
MOST = 8
"""The maximum number of questions that `questions_in` returns."""


_REQUESTING = word_set("tell name explain describe define list remind")
"""Verbs of requests that ask for a fact: *tell me the capital of France*."""


def questions_in(tree: Tree) -> list[str]:
    """Return the questions of an utterance, if it asks several; otherwise an empty list.

    A request for a fact counts as a question: *tell me the capital of France*. A statement with a question word does
    not: *I know when you lie*.
    """
    texts = [text for sentence in sentences_in(tree) for text in _asked_in(tree, sentence)]
    return texts[:MOST] if len(texts) > 1 else []


def _asked_in(tree: Tree, sentence: Sequence[Word]) -> Iterator[str]:
    """Yield the questions and requests of a sentence.

    Each of them begins the sentence, or is a clause with a question word after a conjunction such as *and*.
    """
    ends = [at for at, word in enumerate(sentence) if word.pos == "CCONJ" and _opens(sentence[at + 1 :])]
    start, asks = 0, False
    for end in (*ends, len(sentence)):
        clause = sentence[start:end]
        if end < len(sentence) and not is_finite(clause) and not _requests(clause):
            continue
        start = end + 1
        direct = clause[-1].text.endswith("?") or _is_direct(tree, clause)
        asks = asks or direct or _requests(clause)  # "tell me who I am and where I live"
        if asks:
            added = "?" if direct and end < len(sentence) else ""
            yield tree.phrase(clause).rstrip(" ,") + added


def _is_direct(tree: Tree, clause: Sequence[Word]) -> bool:
    """Return whether a clause has the word order of a question: *where is it*, *who wrote it*, but not *what you mean*."""
    words = [word for word in clause if word.pos not in ("PUNCT", "INTJ", "CCONJ", "SPACE")]
    verb = next((word for word in words if word.tag in FINITE), None)
    if verb is None:
        return False
    if words[0] == verb:
        return verb.pos == "AUX" and any(word.dep in SUBJECTS for word in words)
    first = next(word for word in words if word.pos != "ADP" or word == verb)
    subjects = [word for word in words if word.dep in SUBJECTS and word.index < verb.index]
    return _asks(first) and all(first in tree.subtree(word) for word in subjects)


def _requests(clause: Sequence[Word]) -> bool:
    """Return whether a clause is a request for a fact."""
    said = [word for word in clause if word.pos not in ("PUNCT", "INTJ", "CCONJ") and word.low != "please"]
    if not said or said[0].low not in _REQUESTING or said[0].pos != "VERB":
        return False
    return said[0].low not in ("tell", "remind") or any(word.low in ("me", "us") for word in said[1:2])


def _asks(word: Word) -> bool:
    """Return whether a word is a question word. *That* is no question word."""
    return word.tag in WH and word.low != "that"


def asking(tree: Tree) -> list[list[Word]]:
    """Return the sentences with a question word or a question mark."""
    return [s for s in sentences_in(tree) if any(map(_asks, s)) or s[-1].text.endswith("?")]


def sentences_in(tree: Tree) -> list[list[Word]]:
    """Return the words of each sentence."""
    return [tree.subtree(word) for word in tree.words if word.head == word.index and word.pos != "PUNCT"]


def is_finite(words: Sequence[Word]) -> bool:
    """Return whether words have a finite verb."""
    return any(word.tag in FINITE for word in words)


def _opens(words: Sequence[Word]) -> bool:
    """Return whether words are a clause that begins with a question word, perhaps after a preposition.

    Examples: *who wrote Hamlet*, *in which year was it*.
    """
    first = next((word for word in words if word.pos != "ADP"), None)
    return first is not None and _asks(first) and is_finite(words)
