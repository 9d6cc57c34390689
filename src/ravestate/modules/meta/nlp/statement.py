"""The records of triples and statements. A statement is a triple with flags of its clause, such as negated or past."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

from .phrase import Person, Phrase
from .question_word import QuestionWord


class Triple(NamedTuple):
    """One statement or question of a text, by the conventions of the README.

    Example:
        >>> from ravestate.modules.meta.nlp.question_word import QuestionWord
        >>> Triple("you", "live", QuestionWord.PLACE)  # Where do you live?
        Triple(subject='you', predicate='live', object=QuestionWord.PLACE)
    """

    subject: str | QuestionWord
    """The subject as written; a `QuestionWord` if the question asks for the subject."""
    predicate: str
    """The lemma of the verb; if negated, with ``not`` before it."""
    object: str | QuestionWord
    """The object as written, or empty; a `QuestionWord` if the question asks for the object."""

    def __str__(self) -> str:
        def shown(part: str | QuestionWord) -> str:
            return part.name if isinstance(part, QuestionWord) else part or "-"

        return f"({shown(self.subject)}, {self.predicate}, {shown(self.object)})"


@dataclass(frozen=True, slots=True)
class Statement:
    """One triple of a clause, with its phrases, and with flags that say whether the speaker asserts it.

    Example:
        *my sister Rosa lives in Antwerp* has the triple (my sister Rosa, live, Antwerp); ``subject.head`` is ``sister``,
        ``subject.name`` is ``Rosa``, ``subject.of("I")`` is true; ``object.preposition`` is ``in``. A skill may write::

            for said in analysis.statements:
                if said.holds and said.subject_person == "I" and said.verb == "live":
                    home = said.object.text
    """

    triple: Triple
    """The triple. A `QuestionWord` in it stands for the part that a question asks for."""
    subject: Phrase
    object: Phrase
    """The object; an empty phrase if there is no object."""
    verb: str
    """The lemma of the predicate's last verb. For example, it is ``live`` in *used to live* and *want to live*."""
    phrases: tuple[Phrase, ...] = ()
    """All prepositional phrases of the clause, in order: *as a nurse*, *in a hospital*, *in Hamburg*. A name that
    the clause gives is also here, without a preposition: *Rex*, in *we named our dog Rex*."""
    when: str = ""
    """The time that the clause names, for example ``two years ago``, ``since 2010`` or ``next month``."""
    negated: bool = False
    """The statement is denied: *I don't live here*, *I have no sister*, *I no longer smoke*."""
    past: bool = False
    """The statement was true, and is not true any more: *I lived in Berlin*, *I used to smoke*.

    The flag is false for past events, such as *I moved to Toronto two years ago* or *I was born in Rome*. It is also
    false for *I have lived here since 2010*."""
    hearsay: bool = False
    """Somebody else says or thinks the statement: *my mother says I am lazy*, *people say...*."""
    conditional: bool = False
    """The statement is imagined: *if I lived in Rome*, *I would be happy*, *I wish I were rich*, *maybe he is ill*."""
    plan: bool = False
    """The action is wanted or in the future: *I want to move to Rome*, *I am going to visit him*, *I will call you*."""
    question: bool = False
    """The statement is a question: *do you live here*, *where do you live*."""
    request: bool = False
    """The action is demanded: *give me the book*, *let's play*."""

    @property
    def subject_person(self) -> Person:
        """The person of the subject: ``I`` for *I* and *we*, ``you`` for the agent, and ``other`` for everything else."""
        return self.subject.person

    @property
    def holds(self) -> bool:
        """Whether, according to the speaker, the statement is true now or the event has happened."""
        return not (
            self.negated or self.past or self.hearsay or self.conditional or self.plan or self.question or self.request
        )
