"""The parts of a statement. The quality set ``flags_rows`` measures how well flags such as `hearsay` are found."""

from __future__ import annotations

from ravestate.modules.meta.nlp.pipeline import Pipeline
from ravestate.modules.meta.nlp.statement import Statement
from ravestate.modules.meta.nlp.statements import statements_of


def said(reader: Pipeline, text: str) -> list[Statement]:
    return list(statements_of(*reader.read(text)))


def test_a_statement_before_the_words_my_mother_says_is_hearsay(reader: Pipeline) -> None:
    first, *_ = said(reader, "I am lazy, my mother says.")
    assert first.hearsay and not first.holds


def test_a_relative_has_its_name_and_its_role(reader: Pipeline) -> None:
    (statement,) = said(reader, "My sister Rosa lives in Antwerp.")
    assert (statement.subject.head, statement.subject.name, statement.subject_person) == ("sister", "Rosa", "other")
    assert statement.subject.of("I") and not statement.subject.of("you")
    assert (statement.verb, statement.object.name, statement.object.preposition) == ("live", "Antwerp", "in")


def test_an_owner_can_have_an_owner(reader: Pipeline) -> None:
    (statement,) = said(reader, "My daughter's name is Mia.")
    assert statement.subject.head == "name" and statement.subject.of("I")
    assert statement.subject.owner is not None and statement.subject.owner.head == "daughter"


def test_a_statement_has_the_number_and_the_names_of_its_object(reader: Pipeline) -> None:
    (statement,) = said(reader, "I have two brothers, Max and Tim.")
    assert (statement.object.amount, statement.object.head) == (2, "brother")
    assert statement.object.names == ("Max", "Tim")
    assert said(reader, "I am 34 years old.")[0].object.amount == 34


def test_a_statement_has_all_prepositional_phrases_and_the_time_of_its_clause(reader: Pipeline) -> None:
    (statement,) = said(reader, "I work as a nurse in Hamburg.")
    assert [(phrase.preposition, phrase.text) for phrase in statement.phrases] == [("as", "nurse"), ("in", "Hamburg")]
    assert said(reader, "I moved to Toronto two years ago.")[0].when == "two years ago"
    assert said(reader, "I lived in Berlin until 2010.")[0].when == "until 2010"
