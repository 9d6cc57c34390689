"""The single questions of an utterance are found, and each is analysed."""

import pytest

from ravestate.modules.meta.nlp.analysis import analyse
from ravestate.modules.meta.nlp.pipeline import Pipeline
from ravestate.modules.meta.nlp.questions import MOST


@pytest.mark.parametrize(
    ("text", "questions"),
    [
        (
            "What is the capital of Peru and who wrote Hamlet?",
            ["What is the capital of Peru?", "who wrote Hamlet?"],
        ),
        ("Do you like music? What is the capital of Chad?", ["Do you like music?", "What is the capital of Chad?"]),
        ("Where do Tom and Ann live?", []),
        ("I live here. Where do you live?", []),
        ("hello", []),
        ("", []),
    ],
)
def test_each_question_is_analysed(text: str, questions: list[str], reader: Pipeline) -> None:
    found = analyse(text, reader).questions
    assert [one.text for one in found] == questions
    assert all(one.question is not None and not one.questions for one in found)


def test_only_the_first_of_very_many_questions_are_analysed(reader: Pipeline) -> None:
    assert len(analyse("Who are you? " * 100, reader).questions) == MOST
