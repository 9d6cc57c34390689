"""Questions that refer to the one before. The set ``genqa_references`` measures how well they are completed."""

from __future__ import annotations

import pytest

from ravestate.modules.skill.genqa.referring import Before, completed, other_wordings

POPULATION = Before("what is the population of Austria", "Austria", 0.0)


@pytest.mark.parametrize("heard", ["And its capital?", "how many people live there?", "And of Spain?"])
def test_a_reference_means_nothing_without_a_question_before(heard: str) -> None:
    assert completed(heard, POPULATION) is not None
    assert completed(heard, None) is None


@pytest.mark.parametrize("heard", ["What is the capital of France?", "", "?", "there" * 50_000])
def test_a_complete_question_stays(heard: str) -> None:
    assert completed(heard, POPULATION) == completed(heard, None) == heard


@pytest.mark.parametrize(
    ("before", "subject"),
    [
        (Before("population of the usa", "United States", 0.0), "the usa"),
        (Before("the capital of the netherlands", "Netherlands", 0.0), "the netherlands"),
        (Before("who wrote Hamlet", "Arts", 0.0), ""),
    ],
)
def test_the_subject_is_in_the_questions_own_words(before: Before, subject: str) -> None:
    assert before.subject == subject


def test_another_question_decides_one_of_yes_or_no() -> None:
    assert list(other_wordings("is Peru in Africa")) == ["where is Peru"]
    assert list(other_wordings("who is in Africa")) == []
