"""The flags of statements, and the parts of their phrases."""

from __future__ import annotations

import pytest

from ravestate.modules.meta.nlp.pipeline import Pipeline
from ravestate.modules.meta.nlp.statement import Statement
from ravestate.modules.meta.nlp.statements import statements_of

FLAGS = ("negated", "past", "hearsay", "conditional", "plan", "question", "request")


def said(reader: Pipeline, text: str) -> list[Statement]:
    return list(statements_of(*reader.read(text)))


def flags(statement: Statement) -> str:
    return " ".join(flag for flag in FLAGS if getattr(statement, flag))


@pytest.mark.parametrize(
    "text",
    [
        "I live in Berlin.",
        "I moved to Toronto two years ago.",
        "I was born in Rome.",
        "I have lived here since 2010.",
        "I painted a dragon yesterday.",
        "I have to go home.",
        "I can swim.",
        "I got married last year.",
        "I am 34 years old.",
        "I have been a nurse for ten years.",
        "I grew up in Hamburg.",
        "My brother Tom is a teacher.",
        "I think that I am too shy.",
        "You know that I live in Berlin.",
        "I live in Berlin, and you?",
    ],
)
def test_a_plain_statement_holds(reader: Pipeline, text: str) -> None:
    assert said(reader, text)[-1].holds, flags(said(reader, text)[-1])


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("I don't live in Berlin.", "negated"),
        ("I no longer smoke.", "negated"),
        ("I have no sister.", "negated"),
        ("I don't think that I am shy.", "negated"),
        ("I lived in Berlin until 2010.", "past"),
        ("I used to live in Spain.", "past"),
        ("When I was young I lived in Peru.", "past"),
        ("My father was a baker.", "past"),
        ("I studied physics in Munich.", "past"),
        ("My mother says I live in Berlin.", "hearsay"),
        ("People say that I am lazy.", "hearsay"),
        ("I am lazy, my mother says.", "hearsay"),
        ("My boss thinks I live in Rome.", "hearsay"),
        ("Apparently I am shy.", "hearsay"),
        ("If I lived in Berlin, I would be happy.", "conditional"),
        ("I would live in Rome.", "conditional"),
        ("I wish I lived in Paris.", "conditional"),
        ("Maybe my brother is ill.", "conditional"),
        ("I want to move to Rome.", "plan"),
        ("I would like to live in Rome.", "plan"),
        ("I am going to visit my sister.", "plan"),
        ("I will move to Toronto.", "plan"),
        ("I am moving to Toronto next month.", "plan"),
        ("Do you live in Berlin?", "question"),
        ("do i live in berlin", "question"),
        ("Where do you live?", "question"),
        ("You live in Berlin?", "question"),
        ("Give me the book.", "request"),
        ("Let's play a game.", "request"),
    ],
)
def test_the_flags_of_the_last_clause(reader: Pipeline, text: str, expected: str) -> None:
    statements = said(reader, text)
    main = statements[0] if text == "I am lazy, my mother says." else statements[-1]
    assert flags(main) == expected
    assert not main.holds


def test_a_relative_has_its_name_and_its_role(reader: Pipeline) -> None:
    (statement,) = said(reader, "My sister Rosa lives in Antwerp.")
    assert (statement.subject.head, statement.subject.name, statement.subject_person) == ("sister", "Rosa", "other")
    assert statement.subject.of("I") and not statement.subject.of("you")
    assert (statement.verb, statement.object.name, statement.object.preposition) == ("live", "Antwerp", "in")


def test_an_owner_may_have_an_owner(reader: Pipeline) -> None:
    (statement,) = said(reader, "My daughter's name is Mia.")
    assert statement.subject.head == "name" and statement.subject.of("I")
    assert statement.subject.owner is not None and statement.subject.owner.head == "daughter"


def test_quantities_and_names_of_several(reader: Pipeline) -> None:
    (statement,) = said(reader, "I have two brothers, Max and Tim.")
    assert (statement.object.amount, statement.object.head) == (2, "brother")
    assert statement.object.names == ("Max", "Tim")
    assert said(reader, "I am 34 years old.")[0].object.amount == 34


def test_all_phrases_of_the_clause_and_its_time(reader: Pipeline) -> None:
    (statement,) = said(reader, "I work as a nurse in Hamburg.")
    assert [(phrase.preposition, phrase.text) for phrase in statement.phrases] == [("as", "nurse"), ("in", "Hamburg")]
    assert said(reader, "I moved to Toronto two years ago.")[0].when == "two years ago"
    assert said(reader, "I lived in Berlin until 2010.")[0].when == "until 2010"
