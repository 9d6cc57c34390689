"""The kinds of questions, and the words that ask them."""

from __future__ import annotations

from collections.abc import Sequence
from enum import Enum

from ravestate.language.contractions import word_set

from .tree import Word


class QuestionWord(Enum):
    """A kind of question. In a `Triple`, it stands in the place of the part that the question asks for."""

    PERSON = "person"
    """who, whom, whose"""
    PLACE = "place"
    """where"""
    OBJECT = "object"
    """what, which"""
    FORM = "form"
    """how"""
    TIME = "time"
    """when, what time"""
    REASON = "reason"
    """why"""
    AMOUNT = "amount"
    """how many, how old, how often"""
    YES_NO = "yes_no"
    """A question without a question word; never part of a `Triple`."""

    def __repr__(self) -> str:
        return f"QuestionWord.{self.name}"


QUESTION_WORDS = {
    "who": QuestionWord.PERSON,
    "whom": QuestionWord.PERSON,
    "whose": QuestionWord.PERSON,
    "where": QuestionWord.PLACE,
    "whereabouts": QuestionWord.PLACE,
    "when": QuestionWord.TIME,
    "why": QuestionWord.REASON,
    "how": QuestionWord.FORM,
    "what": QuestionWord.OBJECT,
    "wat": QuestionWord.OBJECT,
    "which": QuestionWord.OBJECT,
}

AUXILIARIES = word_set(
    "do does did am is are was were 's 're s re have has had 've can could will would shall should may might must 'll 'd ca wo "
    "ai",
)
"""Verbs that precede the subject in a question."""

MEASURES = word_set(
    "many much old long far tall big large high deep heavy fast hot cold cool warm expensive often wide small short "
    "young late soon close near thick strong loud rich quickly regularly frequently little few costly",
)
"""Words after *how* that ask for an amount: *how many*, *how old*."""
_CLASSES = {
    QuestionWord.TIME: word_set("time day date hour week month year weekday century decade evening night weekend"),
    QuestionWord.PLACE: word_set(
        "place city town village country state street region county continent district room building neighbourhood location spot"
    ),
    QuestionWord.PERSON: word_set(
        "person people man woman boy girl guy child lady kid friend brother sister cousin uncle aunt colleague neighbour neighbor "
        "teacher doctor nurse author writer poet actor actress singer player composer artist painter scientist inventor student "
        "president minister mayor king queen bloke chap relative classmate"
    ),
    QuestionWord.REASON: word_set("reason"),
    QuestionWord.AMOUNT: word_set("percentage percent proportion"),
}
_CLASS_OF = {noun: kind for kind, nouns in _CLASSES.items() for noun in nouns}
_FOUGHT_FOR = word_set(
    "look wait ask search pay care stand work hope vote apply prepare fight study go know famous long plan shop hunt"
)
"""Words with which *what ... for* asks for a thing, not for a reason: *what are you looking for*."""


def kind_at(words: Sequence[Word], index: int) -> QuestionWord | None:
    """Return the kind of question that the word at `index` asks; None if it is no question word.

    Example: in "how many friends do you have", the word at index 0 asks for an amount.
    """
    word = words[index]
    kind = QUESTION_WORDS.get(word.low)
    if kind is None:
        return None
    rest = words[index + 1 :]
    after = rest[0].low if rest else ""
    if kind is QuestionWord.FORM:
        if after == "come":
            return QuestionWord.REASON
        return QuestionWord.AMOUNT if after in MEASURES else kind
    if kind is QuestionWord.OBJECT:
        if after == "for":
            return QuestionWord.REASON
        for other in rest:
            time = _CLASS_OF.get(other.lemma.lower()) is QuestionWord.TIME
            if other.pos in ("ADJ", "NUM") or (other.dep == "compound" and not time):  # "what room temperature"
                continue
            if index and (words[index - 1].low, other.low) == ("in", "way"):
                return QuestionWord.FORM
            if other.pos in ("NOUN", "PROPN", "VERB"):  # without punctuation, the tagger takes some nouns for verbs
                kind = _CLASS_OF.get(other.lemma.lower(), kind)
            break
        if _asks_what_for(rest):
            return QuestionWord.REASON
    return kind


def _asks_what_for(rest: Sequence[Word]) -> bool:
    """Return whether the rest of a clause asks for a reason with *for*: *what do you need that for*.

    The rest must end with *for* after at least two other words, and have no word of `_FOUGHT_FOR`.
    """
    clause: list[Word] = []
    for word in rest:
        if word.pos == "PUNCT":
            break
        clause.append(word)
    return len(clause) > 2 and clause[-1].low == "for" and not any(word.lemma.lower() in _FOUGHT_FOR for word in clause)
