"""Laws for any text. The set ``hibye_words`` measures greetings and farewells."""

import pytest

from ravestate.modules.meta.idle.words import takes_leave
from ravestate.modules.skill.hibye.words import is_farewell, is_greeting


@pytest.mark.parametrize("text", ["", "🙂", "شكرا", "thanks" + " so" * 3000 + " x", "thank you for " * 3000])
def test_other_texts_are_left_to_other_modules(text: str) -> None:
    assert not is_greeting(text)
    assert not is_farewell(text)


@pytest.mark.parametrize("text", ["bye", "Thanks a lot bye", "Great goodbye", "Anyway I have to go"])
def test_a_user_who_says_goodbye_is_left_in_peace(text: str) -> None:
    assert takes_leave(text)  # or the agent would be bored of a user who is gone
