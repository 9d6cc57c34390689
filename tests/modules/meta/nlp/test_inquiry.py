"""Which texts are questions, and of which kind."""

import pytest

from modules.meta.nlp.sentences import table
from ravestate.modules.meta.nlp.inquiry import question_of
from ravestate.modules.meta.nlp.pipeline import Pipeline


def kind(reader: Pipeline, text: str) -> str:
    tree, _ = reader.read(text)
    found = question_of(tree)
    return found.name if found else "-"


@pytest.mark.parametrize(("sentence", "expected"), table("questions"))
def test_kinds(reader: Pipeline, sentence: str, expected: str) -> None:
    assert kind(reader, sentence) == expected


ONLY_BY_ITS_MARK = (
    "Really?",
    "You live here?",
    "tea or coffee?",
    "so you are a robot?",
    "you don't like me?",
    "coffee?",
    "hungry?",
    "and your brother?",
    "How nice is she?",
)


@pytest.mark.parametrize(
    ("sentence", "expected"),
    [row for row in table("questions") if row[1] != "-" and row[0] not in ONLY_BY_ITS_MARK],
)
def test_question_marks_and_capitals_change_nothing(reader: Pipeline, sentence: str, expected: str) -> None:
    assert kind(reader, sentence.replace("?", "").lower()) == expected


@pytest.mark.parametrize("sentence", ONLY_BY_ITS_MARK[:-1])
def test_a_mark_makes_a_question(reader: Pipeline, sentence: str) -> None:
    assert (kind(reader, sentence), kind(reader, sentence.rstrip("?"))) == ("YES_NO", "-")
