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


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("You are clever!", "compliment"),
        ("You are clever?", ""),
        ("You are not only clever.", "compliment"),
        ("Can I hug you?", "affection"),
        ("The bus was late, but you are clever.", "compliment"),
        ("I won a race and you are clever", "compliment joy"),
        ("If I won a race, you are clever.", ""),
        ("You are clever, oops", "compliment"),
        ("", ""),
    ],
)
def test_each_clause_counts_unless_it_is_a_question_or_a_condition(text: str, found: str) -> None:
    assert " ".join(sorted(feelings([text]))) == found
