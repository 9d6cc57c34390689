"""`Nearest` finds the examples that a sentence resembles most."""

from __future__ import annotations

import pytest

from ravestate.language.nearest import Nearest

EXAMPLES = ["my bike was stolen", "I sold my old bike", "where can I park my bike", "you look tired", "I look tired"]


@pytest.fixture(scope="module")
def index() -> Nearest:
    index = Nearest(EXAMPLES)
    index.load()
    return index


@pytest.mark.parametrize(
    ("sentence", "example"),
    [
        ("somebody stole my bicycle last night", 0),
        ("My old bike is sold.", 1),
        ("Where do I put my bicycle?", 2),
        ("you seem so tired today", 3),
        ("i seem so tired today", 4),
    ],
)
def test_the_nearest_example_has_the_same_meaning_and_the_same_grammatical_person(
    index: Nearest, sentence: str, example: int
) -> None:
    near = index.nearest([sentence])
    assert near[0].place == example
    assert near[0].text == sentence
    assert [one.score for one in near] == sorted((one.score for one in near), reverse=True)


def test_a_sentence_scores_1_for_an_equal_example(index: Nearest) -> None:
    assert index.nearest(["I sold my old bike!"], most=1)[0].score == pytest.approx(1.0, abs=0.01)


def test_a_question_is_less_similar_to_a_statement_than_another_statement_is(index: Nearest) -> None:
    told, asked = index.nearest(["my bike was stolen"], most=1), index.nearest(["my bike was stolen?"], most=1)
    assert asked[0].score < told[0].score


def test_without_sentences_or_examples_nothing_is_found(index: Nearest) -> None:
    assert index.nearest([]) == []
    assert Nearest([]).nearest(["anything"]) == []
