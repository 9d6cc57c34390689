"""The repair of parse trees corrects clauses and questions that the parser misread."""

from itertools import islice

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from ravestate.modules.meta.nlp.contrast import contrasts_of
from ravestate.modules.meta.nlp.inquiry import question_of
from ravestate.modules.meta.nlp.pipeline import Pipeline, pipeline
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


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("I have a dog not a cat", "(I, have, dog) (I, not have, cat)"),
        ("I have a parrot, not a hamster.", "(I, have, parrot) (I, not have, hamster)"),
        ("i like plums not pears", "(i, like, plums) (i, not like, pears)"),
        ("my name is Tom not Tim", "(my name, be, Tom) (my name, not be, Tim)"),
        ("My name isn't Tim but Tom.", "(My name, be, Tom) (My name, not be, Tim)"),
        ("i live in turin not leeds", "(i, live, turin) (i, not live, leeds)"),
        ("I live in Turin, not in Bern.", "(I, live, Turin) (I, not live, Bern)"),
        ("I don't work in Bern but in Turin", "(I, work, Turin) (I, not work, Bern)"),
        ("I live not in Bern but in Turin", "(I, live, Turin) (I, not live, Bern)"),
        ("she is tall not short", "(she, be, tall) (she, not be, short)"),
        ("he's 31 not 13", "(he, be, 31) (he, not be, 13)"),
        ("Jan, not Jon, is my uncle", "(Jan, be, my uncle) (Jon, not be, my uncle)"),
        ("not Jon but Jan is my uncle", "(Jan, be, my uncle) (Jon, not be, my uncle)"),
        # no contrasts
        ("I don't eat anything but rice", "(I, not eat, anything)"),
        ("I don't like tea, but coffee is fine", "(I, not like, tea) (coffee, be, fine)"),
        ("I'm afraid that's not possible", "(I, be, afraid) (that, not be, possible)"),
        ("i not understand", "(i, not understand, -)"),
        ("I don't have a sister or a brother", "(I, not have, sister) (I, not have, brother)"),
    ],
)
def test_a_contrast_asserts_one_phrase_and_denies_only_the_other(text: str, expected: str, reader: Pipeline) -> None:
    assert triples(reader, text) == expected


def test_a_statement_has_no_phrase_that_its_contrast_excludes(reader: Pipeline) -> None:
    turin, bern = statements_of(reader.read("I live in Turin, not in Bern")[0])
    assert [phrase.text for phrase in turin.phrases] == ["Turin"]
    assert [phrase.text for phrase in bern.phrases] == ["Bern"]
    assert turin.holds and bern.negated


@pytest.mark.parametrize(
    ("text", "pair"),
    [
        ("Turin, not Bern", ("Turin", "Bern")),
        ("turin not leeds", ("turin", "leeds")),
        ("not Bern, Turin", ("Turin", "Bern")),
        ("not bern but turin", ("turin", "bern")),
        ("i said turin not bern", ("turin", "bern")),
        ("it's Turin, not Bern", ("Turin", "Bern")),
        ("Tim is my cousin, not my brother", ("my cousin", "my brother")),
    ],
)
def test_contrasts_are_found_in_texts_without_a_verb_as_well(
    text: str, pair: tuple[str, str], reader: Pipeline
) -> None:
    (found,) = contrasts_of(repaired(reader.read(text)[0]))
    assert (found.right.text, found.wrong.text) == pair


@given(
    st.lists(
        st.sampled_from(
            [
                "not",
                "but",
                ",",
                ".",
                "no",
                "and",
                "I",
                "my",
                "sister",
                "Tom",
                "Leeds",
                "live",
                "in",
                "is",
                "isn't",
                "a",
                "dog",
                "tall",
                "that",
                "of",
            ]
        )
    )
)
@example(["dog", ","]).via("a comma with nothing after it")
@example(["that", "'s", "misty", "outside", ",", "not", "sunny"]).via("once a tree with a circle")
@settings(max_examples=200, deadline=None)
def test_every_word_of_a_repaired_tree_leads_to_a_root(words: list[str]) -> None:
    tree = repaired(pipeline("").read(" ".join(words))[0])
    for word in tree.words:
        above = [word, *islice(tree.ancestors(word), len(tree.words))]
        assert above[-1].head == above[-1].index
    contrasts_of(tree)


@pytest.mark.parametrize("text", ["my name not tom", "why not pizza", "not now", "I live in Rome, not all the time"])
def test_a_negation_that_names_no_alternative_is_not_a_contrast(text: str, reader: Pipeline) -> None:
    assert contrasts_of(repaired(reader.read(text)[0])) == ()


@pytest.mark.parametrize("text", ["I'm thinking of moving to Bern", "we are moving to Bern"])
def test_an_intended_action_counts_as_a_plan(text: str, reader: Pipeline) -> None:
    assert all(statement.plan for statement in statements_of(reader.read(text)[0]))
