"""The agent's name stands for *you*, or only calls the agent."""

from __future__ import annotations

import pytest

from ravestate.language.addressing import addressed


@pytest.mark.parametrize(
    ("sentence", "meaning"),
    [
        ("What are Robin's hobbies?", "What are your hobbies?"),
        ("How old is Robin?", "How old are you?"),
        ("robin, how old are you?", "how old are you?"),
        ("How are you, Robin?", "How are you?"),
        ("Robinson is nice.", "Robinson is nice."),
        ("Robin is clever", "you are clever"),
        ("robin's so cute", "you are so cute"),
        ("I love Robin.", "I love you."),
        ("this little robot is great", "you are great"),
        ("this robot is great, thank you", "you are great, thank you"),
        ("Robin has won", "you have won"),
        ("", ""),
    ],
)
def test_a_name_stands_for_you_unless_it_only_calls(sentence: str, meaning: str) -> None:
    assert addressed(sentence, ["Robin", ""]) == meaning
