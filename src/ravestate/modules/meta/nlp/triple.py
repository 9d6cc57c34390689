"""A triple of subject, predicate and object."""

from __future__ import annotations

from typing import NamedTuple

from .question_word import QuestionWord


class Triple(NamedTuple):
    """One statement or question of a text, by the conventions of the README.

    Example:
        >>> from ravestate.modules.meta.nlp.question_word import QuestionWord
        >>> Triple("you", "live", QuestionWord.PLACE)  # Where do you live?
        Triple(subject='you', predicate='live', object=QuestionWord.PLACE)
    """

    subject: str | QuestionWord
    """As written; a `QuestionWord` if the question asks for the subject."""
    predicate: str
    """The lemma, after ``not`` if negated."""
    object: str | QuestionWord
    """As written, or empty; a `QuestionWord` if the question asks for it."""

    def __str__(self) -> str:
        def shown(part: str | QuestionWord) -> str:
            return part.name if isinstance(part, QuestionWord) else part or "-"

        return f"({shown(self.subject)}, {self.predicate}, {shown(self.object)})"
