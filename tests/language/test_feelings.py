"""Feelings that a user's words express. `tests/quality` measures how many sentences are understood."""

import pytest

from ravestate.language import feelings as room
from ravestate.language.feelings import feelings
from ravestate.language.matcher import Matcher

EXAMPLES = {
    "compliment": ["you are clever", "you are not only clever"],
    "affection": ["I love you", "can I hug you"],
    "joy": ["I won a race"],
}


@pytest.fixture(autouse=True)
def lexicon(monkeypatch: pytest.MonkeyPatch) -> None:
    """Use a matcher that has not loaded the model, so only its exact examples are recognised."""
    matcher = Matcher(EXAMPLES)
    monkeypatch.setattr(room, "bundled_matcher", lambda _: matcher)


def found(text: str) -> set[str]:
    return set(feelings([text]))


def test_each_clause_counts_unless_it_is_a_question_or_a_condition() -> None:
    for feeling, example in (("compliment", "you are clever"), ("joy", "I won a race")):
        assert (
            found(f"{example}!") == found(f"The bus was late, but {example}.") == found(f"{example}, oops") == {feeling}
        )
        assert found(f"{example}?") == found(f"If it is warm, {example}.") == set()
    assert found("I won a race and you are clever") == {"compliment", "joy"}


def test_an_example_may_itself_be_a_question_or_have_a_negation() -> None:
    assert found("Can I hug you?") == {"affection"}
    assert found("You are not only clever.") == {"compliment"}
    assert found("") == set()
