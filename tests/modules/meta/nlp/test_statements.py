"""Properties that hold for the triples of any text. `tests/quality` measures how often triples are right."""

import pytest

from ravestate.modules.meta.nlp.pipeline import Pipeline
from ravestate.modules.meta.nlp.question_word import QuestionWord
from ravestate.modules.meta.nlp.statements import MOST, triples_of


@pytest.mark.parametrize("text", ["", "   ", "yes", "the red car", "?!", "Nice to meet you"])
def test_a_text_without_a_statement_has_no_triple(reader: Pipeline, text: str) -> None:
    assert triples_of(reader.read(text)[0]) == ()


def test_a_question_word_in_a_triple_is_an_enumeration_member(reader: Pipeline) -> None:
    tree, _ = reader.read("Where do you live?")
    (triple,) = triples_of(tree)
    assert triple.object is QuestionWord.PLACE and str(triple) == "(you, live, PLACE)"


def test_long_enumerations_give_a_limited_number_of_triples(reader: Pipeline) -> None:
    names = " and ".join(f"Anna{number}" for number in range(40))
    tree, _ = reader.read(f"{names} like {names}.")
    assert len(triples_of(tree)) <= MOST
