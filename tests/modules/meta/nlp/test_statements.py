"""Triples, by the conventions of the module's README.

The sentences of ``triples.tsv`` were written with the rules, so they say what works, not how well: that is measured
elsewhere, on sentences that nobody tuned on.
"""

import pytest

from modules.meta.nlp.sentences import table
from ravestate.modules.meta.nlp.pipeline import Pipeline
from ravestate.modules.meta.nlp.question_word import QuestionWord
from ravestate.modules.meta.nlp.statements import MOST, triples_of


def shown(part: str | QuestionWord) -> str:
    return (part.name if isinstance(part, QuestionWord) else part.replace(" ", "_")) or "_"


def triples(reader: Pipeline, text: str) -> set[str]:
    tree, _ = reader.read(text)
    return {f"{shown(t.subject)} {shown(t.predicate)} {shown(t.object)}" for t in triples_of(tree)}


@pytest.mark.parametrize(("sentence", "expected"), table("triples"))
def test_triples(reader: Pipeline, sentence: str, expected: str) -> None:
    assert triples(reader, sentence) == {triple.strip() for triple in expected.split(";")}


@pytest.mark.parametrize("text", ["", "   ", "yes", "the red car", "?!", "Nice to meet you"])
def test_what_states_nothing_has_no_triple(reader: Pipeline, text: str) -> None:
    assert triples(reader, text) == set()


def test_question_words_are_no_strings(reader: Pipeline) -> None:
    tree, _ = reader.read("Where do you live?")
    (triple,) = triples_of(tree)
    assert triple.object is QuestionWord.PLACE and str(triple) == "(you, live, PLACE)"


def test_enumerations_do_not_multiply_without_end(reader: Pipeline) -> None:
    names = " and ".join(f"Anna{number}" for number in range(40))
    tree, _ = reader.read(f"{names} like {names}.")
    assert len(triples_of(tree)) <= MOST
