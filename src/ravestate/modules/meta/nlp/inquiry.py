"""Recognise questions and their kinds.

A small network (``kinds.onnx``, trained in ``tools/networks``) reads each sentence. Until it is loaded, or without the
sentence model, the first words and the question mark of a sentence decide.
"""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path

from ravestate.language.classifier import Classifier
from ravestate.language.sentences import sentences

from .question_word import QUESTION_WORDS, QuestionWord

_OPENING = re.compile(r"\W*(?:(?:and|but|so|well|oh|ok|okay|hi|hello|hey)\W+)*(\w+)\W+(\w*)", re.IGNORECASE)
"""The first two words of a sentence, without words such as *and*."""
_AMOUNTS = frozenset(("many", "much", "old", "long", "far", "tall", "big", "often", "high"))
_MOST = 6
"""The maximum number of sentences that are read."""


def question_of(text: str) -> QuestionWord | None:
    """Return the kind of the first question in a text in normal form; None if the text has no question.

    Example:
        >>> question_of("I see. Where do you live?")
        QuestionWord.PLACE
    """
    found = (_kind(sentence) for sentence in sentences(text)[:_MOST])
    return next((kind for kind in found if kind is not None), None)


def _kind(sentence: str) -> QuestionWord | None:
    name = kinds().best(sentence)[0] or _plain_kind(sentence)
    if name == "-":
        return QuestionWord.YES_NO if sentence.endswith("?") else None
    return QuestionWord[name]


def _plain_kind(sentence: str) -> str:
    """Return the kind by the first words and the question mark."""
    first, second = opening.group(1, 2) if (opening := _OPENING.match(f"{sentence} ")) else ("", "")
    kind = QUESTION_WORDS.get(first.lower())
    if kind is QuestionWord.FORM and second.lower() in _AMOUNTS:
        kind = QuestionWord.AMOUNT
    return "-" if kind is None else kind.name


@cache
def kinds() -> Classifier:
    """Return the classifier of questions, which all contexts share. It may not be loaded yet."""
    return Classifier(Path(__file__).with_name("kinds.onnx"))
