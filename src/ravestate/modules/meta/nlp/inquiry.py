"""Recognise questions and their kinds.

The functions use words, their order, and question marks. They ignore the dependency tree. It is unreliable for
questions without capitals and punctuation, such as those from speech recognition.
"""

from __future__ import annotations

from collections.abc import Sequence

from .asking import AUXILIARIES, QUESTION_WORDS, kind_at
from .pattern import phrases
from .question_word import QuestionWord
from .tree import Tree, Word
from .word_set import word_set

_OPENERS = word_set(
    "well so oh ok okay hi hello hey hallo good morning evening afternoon um uh hmm ah and but or then now please sorry excuse ",
    "me thanks great fine yes no yeah nice cool right alright also actually just by the way anyway sure wow haha",
)
"""Words without meaning before a question."""

_PRONOUNS = word_set(
    "i you u he she it we they there this that these those someone somebody anyone anybody everyone everybody your my his her ",
    "our their ya yours his hers",
)
_DETERMINERS = word_set("the a an any some all")
_NOT = frozenset(["not", "n't", "nt", "n’t"])
_BE = word_set("am is are was were 's 're s re")
_KNOWING = word_set(
    "know remember tell say explain guess wonder wondering ask asking see understand show recall forget idea sure figure ",
    "mean heard matter care curious describe",
)
"""Words before an indirect question."""

_TELL = phrases("""
    (|please|do) tell (me|us); (can|could|would|will) you (|please) tell (me|us); would you mind telling (me|us);
    i (want|need|would like|'d like|d like|would love|'d love|d love|like) to know; i wanna know; (may|can|could|might) i know
""")
"""The beginnings of requests for information."""

_OPENINGS = [
    *_TELL,
    *phrases("""
        i wonder; i (was|am|'m|m) wondering; wondering; i (am|'m|m) curious; i (would be|am|'m|m) interested to know;
        (may|can|could|might) i ask (|you); let me (ask|ask you|know); (can|could|would) you (say|explain|explain to me|show me);
        explain (|to me); show me; remind me; say; guess; any idea; (do you have|have you) any idea;
        (do|did) you know; do you happen to know; do you remember
    """),
]
"""The beginnings of indirect questions."""
_OPENINGS.sort(key=len, reverse=True)

_PERFORMED = word_set("joke story tale poem riddle secret lie fairytale anecdote goodnight")
"""Things to perform, such as jokes: a request for one is not a question."""


def question_of(tree: Tree) -> QuestionWord | None:
    """Return the kind of the first question in the text; None without one."""
    for sentence, asked in _sentences(tree):
        if (kind := _kind(sentence, asked)) is not None:
            return kind
    return None


def _sentences(tree: Tree) -> list[tuple[list[Word], bool]]:
    """Return the sentences, each with whether a question mark ends it."""
    found: list[tuple[list[Word], bool]] = []
    words: list[Word] = []
    ends: set[str] = set()
    last = -1
    for word in tree.words:
        ending = not word.low.strip(".!?…") or "\n" in tree.text[last + 1 : word.start]
        if words and ends and word.low.strip(".!?…)\"'"):
            found.append((words, "?" in ends))
            words, ends = [], set()
        if ending and not word.low.strip(".!?…"):
            ends |= set(word.low)
        elif ending:
            if words:
                found.append((words, False))
            words = [word]
        else:
            words.append(word)
        last = word.end - 1
    if words or "?" in ends:
        found.append((words, "?" in ends))
    return found


def _kind(sentence: Sequence[Word], asked: bool) -> QuestionWord | None:
    if not sentence:
        return None
    parts = _parts(sentence)
    for part in parts:
        if (kind := _indirect(part)) is not None:
            return kind
        if _is_request_to_tell(part):
            return QuestionWord.OBJECT
        if (kind := _direct(part, asked, alone=len(parts) == 1 or part is parts[-1])) is not None:
            return kind
    if (kind := _within(sentence)) is not None:
        return kind
    if _has_tag(sentence):
        return QuestionWord.YES_NO
    if sentence[-1].low in QUESTION_WORDS and (asked or sentence[0].low == "you"):  # you live where
        return kind_at(sentence, len(sentence) - 1)
    if asked:
        return QuestionWord.YES_NO
    if [word.low for word in sentence[:3]] in (["and", "you"], ["and", "yours"]):
        return QuestionWord.YES_NO
    return None


def _parts(sentence: Sequence[Word]) -> list[list[Word]]:
    """Return the parts between commas, without opening words."""
    parts: list[list[Word]] = [[]]
    for word in sentence:
        if word.pos == "PUNCT" and word.low in ",;:-–—":
            parts.append([])
        elif word.pos != "PUNCT":
            parts[-1].append(word)
    found: list[list[Word]] = []
    for part in parts:
        begin = 0
        while begin < len(part) - 1 and part[begin].low in _OPENERS:
            if part[begin].low == "so" and len(part) == begin + 3 and part[-1].low in _PRONOUNS:
                break  # so do I
            begin += 1
        if part[begin:]:
            found.append(part[begin:])
    return found


def _direct(part: Sequence[Word], asked: bool, *, alone: bool) -> QuestionWord | None:
    """Return the kind of a question that begins with its question word or its verb."""
    begin = 1 if len(part) > 1 and part[0].pos in ("ADP", "SCONJ") and part[0].low not in QUESTION_WORDS else 0
    first = part[begin]
    if (kind := kind_at(part, begin)) is not None and (begin == 0 or part[0].low != "like"):
        return kind if _asks(part[begin:], asked, alone=alone) else None
    if begin:
        return None
    if _is_inverted(part, asked) and first.low not in QUESTION_WORDS:
        return QuestionWord.YES_NO
    return None


def _asks(words: Sequence[Word], asked: bool, *, alone: bool) -> bool:
    """Return whether words that begin with a question word are a question, not an exclamation or a subordinate clause."""
    word, rest = words[0].low, words[1:]
    if not rest:
        return True
    verb = _first_verb(rest)
    if word in ("what", "how") and not asked and _is_exclamation(word, rest):
        return False
    for index in range(min(len(rest), 5)):
        if _inverted_at(rest, index):
            return True
        if rest[index].low in ("i", "you", "he", "she", "it", "we", "they"):  # what I like is football
            break
    if word == "how" and rest[0].low in ("many", "much") and rest[1:] and rest[1].low not in _PRONOUNS:
        return True
    if word in ("when", "where") and not (asked and alone):
        return verb is None and len(rest) < 3
    if word in ("who", "whom", "whose", "which"):
        return True
    if asked and alone:
        return True
    if rest[0].low in ("about", "come", "not", "so", "else", "if", "up", "exactly", "for", "to"):
        return True
    if word == "what":  # what happened, but not: what I like
        return rest[0].low not in _PRONOUNS or rest[0].low in ("that", "this", "there", "is")
    if word in ("why", "how"):
        return rest[0].low in AUXILIARIES or (rest[0].low in ("you", "u") and len(rest) <= 3) or verb is None
    return False


def _is_exclamation(word: str, rest: Sequence[Word]) -> bool:
    """Return whether it is an exclamation: *what a nice day*, *how nice of you*."""
    if word == "what":
        return rest[0].low in ("a", "an") and not any(_inverted_at(rest, i) for i in range(len(rest)))
    if rest[1:] and rest[1].low == "of":
        return True
    return (
        rest[0].pos in ("ADJ", "ADV")
        and rest[0].low not in ("many", "much", "long", "far", "often", "old", "come")
        and not any(word.low in AUXILIARIES for word in rest)
    )


def _first_verb(words: Sequence[Word]) -> Word | None:
    return next((word for word in words if word.pos in ("VERB", "AUX")), None)


def _inverted_at(words: Sequence[Word], index: int) -> bool:
    """Return whether the word at `index` is an auxiliary before its subject."""
    if words[index].low not in AUXILIARIES:
        return False
    rest = [word for word in words[index + 1 :] if word.low not in _NOT]
    if not rest:
        return index == 0 and words[index].low in _BE
    return (
        rest[0].low in _PRONOUNS
        or rest[0].low in _DETERMINERS
        or rest[0].pos in ("PROPN", "NOUN", "PRON", "DET", "NUM", "ADJ", "VERB", "ADV")
    ) and (index == 0 or words[index - 1].low not in _PRONOUNS)


def _is_inverted(words: Sequence[Word], asked: bool) -> bool:
    """Return whether the verb precedes its subject: *do you like games*, but not *do the dishes*."""
    first = words[0].low
    if first not in AUXILIARIES or first.startswith("'") or first in ("s", "re"):
        return False
    rest = [word for word in words[1:] if word.low not in _NOT]
    negated = len(rest) < len(words) - 1
    if not rest:
        return False
    subject = rest[0].low
    if first in ("do", "have", "may") and subject not in (
        "you",
        "u",
        "i",
        "we",
        "they",
        "he",
        "she",
        "ya",
        "there",
    ):
        if first == "do" and (asked or (not negated and subject not in ("it", "that", "this"))):
            return any(word.tag in ("VB", "VBP") for word in rest[1:])  # do your parents live here
        return asked
    if first == "do" and negated and words[1].low in _NOT and subject not in ("you", "we", "they", "i"):
        return asked
    if first in _BE and subject in ("a", "an", "not", "so", "very") and not asked:
        return False  # was a nice day
    return subject in _PRONOUNS or subject in _DETERMINERS or rest[0].pos in ("PROPN", "NOUN", "PRON", "DET", "ADJ")


def _within(words: Sequence[Word]) -> QuestionWord | None:
    """Return the kind of a question after other words without a comma: *my name is tom what is yours*."""
    low = [word.low for word in words]
    for index in range(1, len(words) - 1):
        if low[index] in QUESTION_WORDS and low[index - 1] not in _KNOWING:
            skipped = index + 1
            while skipped < min(index + 4, len(words) - 1) and low[skipped] not in AUXILIARIES:
                skipped += 1
            if (
                low[skipped] in AUXILIARIES
                and skipped + 1 < len(words)
                and low[skipped + 1] in _PRONOUNS
                and not any(verb in low[:index] for verb in ("know", "wonder"))
            ):
                return kind_at(words, index)
        if (
            low[index] in ("do", "are", "can", "did", "could", "would", "will", "have")
            and low[index + 1] in ("you", "u")
            and low[index - 1] not in ("so", "neither", "nor", *QUESTION_WORDS)
            and index + 2 < len(words)
            and not any(word in QUESTION_WORDS for word in low[:index])
        ):
            return QuestionWord.YES_NO
    return None


def _indirect(part: Sequence[Word]) -> QuestionWord | None:
    """Return the kind of an indirect question: *tell me when it begins*."""
    low = tuple(word.low for word in part)
    for opening in _OPENINGS:
        if low[: len(opening)] != opening:
            continue
        for index in range(len(opening), min(len(opening) + 4, len(part))):
            if low[index] in ("if", "whether"):
                return QuestionWord.YES_NO
            if (kind := kind_at(part, index)) is not None:
                if low == ("guess", "what"):
                    return None
                if index == len(opening) or part[index - 1].pos in (
                    "ADP",
                    "ADV",
                    "INTJ",
                    "PRON",
                    "DET",
                    "CCONJ",
                ):
                    return kind
                break
        return None
    return None


def _is_request_to_tell(part: Sequence[Word]) -> bool:
    """Return whether it requests information: *tell me your name*, but not *tell me a joke*."""
    low = tuple(word.low for word in part)
    for opening in _TELL:
        if low[: len(opening)] == opening:
            rest = part[len(opening) :]
            if not rest or any(word.lemma.lower() in _PERFORMED for word in rest):
                return False
            return rest[0].low not in ("that", "a", "an", "again", "to", "not")
    return False


def _has_tag(sentence: Sequence[Word]) -> bool:
    """Return whether it ends with a question tag: *nice day isn't it*, *you live here, right*."""
    low = [word.low for word in sentence if word.pos != "PUNCT"]
    comma = any(word.low == "," for word in sentence[-4:])
    if len(low) < 3:
        return False
    if low[-1] in ("right", "correct", "huh", "eh", "yes") and comma:
        return True
    if low[-1] not in _PRONOUNS or low[0] in ("so", "neither", "nor") or low[0] in QUESTION_WORDS:
        return False
    if low[-2] in _NOT and low[-3] in AUXILIARIES and len(low) > 3:
        return True
    return low[-2] in AUXILIARIES and comma
