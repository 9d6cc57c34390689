"""The agent answers with a sentence that the user has said."""

from __future__ import annotations

import pytest

from ravestate.modules.skill.persqa.recollection import recollect

TOLD = (
    "I keep bees behind the garage.",
    "Each hive gives 30 jars.",
    "My neighbour Olga waters the roses.",
    "The train was late again this morning.",
)


@pytest.mark.parametrize(
    ("question", "answer"),
    [
        ("Who waters the roses?", "My neighbour Olga waters the roses."),
        ("Where do I keep my bees?", "I keep bees behind the garage."),
    ],
)
def test_the_sentence_that_answers_the_question_is_quoted(question: str, answer: str) -> None:
    assert recollect(question, TOLD) == answer


def test_two_adjacent_sentences_can_answer_together() -> None:
    told = ("The shop opens at nine.", "I bake rolls at the mill.", "Every night 400.", "It rains.")
    assert (
        recollect("Do you remember how many rolls I bake in one night?", told)
        == "I bake rolls at the mill. Every night 400."
    )


@pytest.mark.parametrize("question", ["What was the colour of my first car?", "Which instrument did I learn?"])
def test_a_sentence_that_answers_another_question_is_not_quoted(question: str) -> None:
    assert recollect(question, TOLD) == ""


def test_before_the_user_has_told_anything_nothing_is_quoted() -> None:
    assert recollect("What did I say?", ()) == ""
