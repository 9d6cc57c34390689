"""Recognise questions and their kinds.

The network (`language.network`) reads each sentence. Until the network is loaded, or
without the sentence model, the first words and the question mark of a sentence decide.
"""

from __future__ import annotations

import re

from ravestate.language.classifier import Classifier
from ravestate.language.network import LONGEST
from ravestate.language.sentences import sentences

from .question_word import MEASURES, QUESTION_WORDS, QuestionWord

_OPENING = re.compile(r"\W*(?:(?:and|but|so|well|oh|ok|okay|hi|hello|hey)\W+)*(\w+)\W+(\w*)", re.IGNORECASE)
"""The first two words of a sentence, without words such as *and*."""
_MOST = 12
"""The maximum number of sentences that are read: half of them from the beginning, and half from the end."""
_KINDS = Classifier("kinds")


def question_of(text: str) -> QuestionWord | None:
    """Return the kind of the first question in a text in normal form; None if the text has no question.

    Only the first and the last six sentences of a text are read, and the first and the last 300 characters of a
    sentence.

    Example:
        >>> question_of("I see. Where do you live?")
        <QuestionWord.PLACE: 'place'>
    """
    found = sentences(text)
    read = found if len(found) <= _MOST else (*found[: _MOST // 2], *found[-_MOST // 2 :])
    parts = (part for sentence in read for part in dict.fromkeys((sentence[:LONGEST], sentence[-LONGEST:])))
    return next((kind for kind in map(_kind, parts) if kind is not None), None)


def _kind(sentence: str) -> QuestionWord | None:
    name = _KINDS.best(sentence)[0] or _plain_kind(sentence)
    if name == "-":
        return QuestionWord.YES_NO if "?" in sentence else None
    return QuestionWord[name]


def _plain_kind(sentence: str) -> str:
    """Return the kind of a sentence by its first words, if it has a question mark."""
    opening = _OPENING.match(f"{sentence} ") if "?" in sentence else None
    first, second = opening.group(1, 2) if opening else ("", "")
    kind = QUESTION_WORDS.get(first.lower())
    if kind is QuestionWord.FORM and second.lower() in MEASURES:
        kind = QuestionWord.AMOUNT
    return "-" if kind is None else kind.name
