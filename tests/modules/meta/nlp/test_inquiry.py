"""Questions and their kinds. The quality sets ``kinds_rows``, ``kinds_fresh_rows`` and ``questions_rows`` have more."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from ravestate.language.network import Network, network
from ravestate.modules.meta.nlp import QuestionWord
from ravestate.modules.meta.nlp.analysis import analyse
from ravestate.modules.meta.nlp.inquiry import question_of
from ravestate.modules.meta.nlp.pipeline import pipeline

ASKED = [
    ("Where do they keep the umbrellas?", QuestionWord.PLACE),
    ("Who left the gate open?", QuestionWord.PERSON),
    ("How many eggs are left?", QuestionWord.AMOUNT),
    ("Why did the lift stop?", QuestionWord.REASON),
]


@pytest.mark.parametrize(("text", "kind"), ASKED)
def test_common_questions_need_no_sentence_model(
    text: str, kind: QuestionWord, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(Network, "loaded", False)
    assert question_of(text) is kind
    assert question_of("The lift has stopped.") is None
    assert question_of("The lift has stopped?") is QuestionWord.YES_NO
    assert question_of("When I was young I lived in Berlin.") is None
    assert analyse("do you like games", pipeline("")).question is QuestionWord.YES_NO


@pytest.mark.parametrize(("text", "kind"), ASKED)
@pytest.mark.parametrize(("other", "second"), ASKED)
def test_the_first_of_several_questions_counts(text: str, kind: QuestionWord, other: str, second: QuestionWord) -> None:
    assert question_of(f"I see. {text} {other}") is kind
    assert question_of(f"{other} {text}") is second


@given(st.text(max_size=300))
def test_every_text_has_one_kind_or_none(text: str) -> None:
    assert question_of(text) in (None, *QuestionWord)


@pytest.mark.parametrize("text", ["the blue one?", "The blue one?!", "really?!"])
def test_a_question_mark_that_the_user_typed_makes_a_question(text: str) -> None:
    assert analyse(text, pipeline("")).question is not None


def test_an_added_question_mark_does_not_count() -> None:
    normal = analyse("is raining here", pipeline("")).normal
    assert normal.text.endswith("?") and not normal.unguessed.endswith("?")


def test_the_question_at_the_end_of_a_long_text_is_found() -> None:
    told = "I went down to the harbour. The boats were back. "
    assert question_of(told * 20 + "Where do you live?") is QuestionWord.PLACE
    assert question_of("and then we went on " * 30 + "so where do you live?") is QuestionWord.PLACE


def test_the_network_knows_the_kinds_of_questions() -> None:
    assert set(network().labels("kinds")) == {*(kind.name for kind in QuestionWord), "-"}
