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
        (
            "Tell me the capital of France. Who wrote Hamlet? Who wrote Faust?",
            ["Tell me the capital of France.", "Who wrote Hamlet?", "Who wrote Faust?"],
        ),
        ("Name the capital of Peru and who wrote Hamlet", ["Name the capital of Peru", "who wrote Hamlet"]),
        ("Do you know who I am and where I live?", ["Do you know who I am?", "where I live?"]),
        ("I have a cat that purrs. Who are you and where am I?", ["Who are you?", "where am I?"]),
        (
            "In which year was it and how many people live there?",
            ["In which year was it?", "how many people live there?"],
        ),
        ("I have a dog that barks. I have a cat that purrs.", []),
        ("I have a dog that barks. Do you have a dog that barks?", []),
        ("I know what you mean and when you lie.", []),
        ("I know what you mean and when you lie. Who are you?", []),
        ("When you lie, I know. I like what you say.", []),
        ("I met Tom, who is nice, and who likes jazz.", []),
        ("I like tea and when it rains I read. Who are you?", []),
        ("Tell my mum I love her. Who are you?", []),
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
