"""The repair of parse trees corrects clauses and questions that the parser misread."""

import pytest

from ravestate.modules.meta.nlp.inquiry import question_of
from ravestate.modules.meta.nlp.pipeline import Pipeline
from ravestate.modules.meta.nlp.repair import repaired, tag_at
from ravestate.modules.meta.nlp.statements import statements_of, triples_of


def triples(reader: Pipeline, text: str) -> str:
    return " ".join(map(str, triples_of(reader.read(text)[0])))


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("When did the concert end?", "(concert, end, TIME)"),
        ("How long does the flight take?", "(flight, take, AMOUNT)"),
        ("Do robots dream?", "(robots, dream, -)"),
        ("Was the fence painted by your uncle?", "(your uncle, paint, fence)"),
        ("Are your parents still married?", "(your parents, be, married)"),
        ("There is something I want to tell you.", "(something, be, -) (I, want to tell, something)"),
        ("can't find my keys", "(I, not find, my keys)"),
        ("my husband's Albert", "(my husband, be, Albert)"),
        ("my uncle Bert is a cook and my aunt Vera is a pilot", "(my uncle Bert, be, cook) (my aunt Vera, be, pilot)"),
        ("moved to Leeds in May", "(I, move, Leeds)"),
        ("born in Rome", "(I, be born, Rome)"),
        ("we like swimming and tennis", "(we, like, swimming) (we, like, tennis)"),
    ],
)
def test_a_clause_that_the_parser_misreads_has_the_right_triple(text: str, expected: str, reader: Pipeline) -> None:
    assert triples(reader, text) == expected


def test_homework_after_do_is_read_as_a_noun(reader: Pipeline) -> None:
    assert triples(reader, "do your math homework").startswith("(you, do,")


@pytest.mark.parametrize("text", ["You like tea, don't you?", "you can dance cant you", "It is late, isn't it"])
def test_a_question_tag_turns_a_statement_into_a_question_and_adds_no_triple(text: str, reader: Pipeline) -> None:
    tree, _ = reader.read(text)
    assert question_of(tree) is not None and question_of(tree).name == "YES_NO"  # pyright: ignore[reportOptionalMemberAccess]
    (statement,) = statements_of(tree)
    assert statement.question and not statement.negated


def test_a_correct_tree_stays_as_it_is(reader: Pipeline) -> None:
    tree, _ = reader.read("My sister lives in Rome.")
    assert repaired(tree) is tree
    assert not any(tag_at(tree.words, word.index) for word in tree.words)


@pytest.mark.parametrize(
    ("text", "kind"),
    [
        ("My uncle, who repairs bikes, lives near Cologne.", "-"),
        ("Here is your coffee.", "-"),
        ("what beautiful eyes you have", "-"),
        ("where you live", "PLACE"),
        ("how much you weigh", "AMOUNT"),
        ("why you so mean", "REASON"),
        ("where do penguins live", "PLACE"),
        ("you are a robot right", "YES_NO"),
        ("you know any songs", "YES_NO"),
        ("Guess what, I passed.", "-"),
    ],
)
def test_the_kind_of_a_question_is_found_without_a_question_mark_or_an_auxiliary(
    text: str, kind: str, reader: Pipeline
) -> None:
    found = question_of(reader.read(text)[0])
    assert (found.name if found else "-") == kind


def test_a_noun_with_a_capital_inside_a_sentence_is_a_name(reader: Pipeline) -> None:
    (statement,) = statements_of(reader.read("my girlfriend Chiara bakes wonderful cakes")[0])
    assert statement.subject.names == ("Chiara",) and statement.subject.head == "girlfriend"


@pytest.mark.parametrize("text", ["I'm thinking of moving to Bern", "we are moving to Bern"])
def test_an_intended_action_counts_as_a_plan(text: str, reader: Pipeline) -> None:
    assert all(statement.plan for statement in statements_of(reader.read(text)[0]))
