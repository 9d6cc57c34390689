"""In a sentence, the agent's name either means *you* or only addresses the agent."""

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
def test_the_agents_name_becomes_you_unless_it_only_addresses_the_agent(sentence: str, meaning: str) -> None:
    assert addressed(sentence, ["Robin", ""]) == meaning
