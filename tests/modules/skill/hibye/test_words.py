"""What counts as nothing but a greeting or a farewell."""

import pytest

from ravestate.modules.meta.idle.words import takes_leave
from ravestate.modules.skill.hibye.words import is_farewell, is_greeting


@pytest.mark.parametrize(
    "text",
    ["hi", "Hello!", "  hey there", "HELLO my dear robot", "good morning", "Hallo", "hiii", "Guten Tag!"],
)
def test_a_greeting_greets_and_does_not_take_leave(text: str) -> None:
    assert is_greeting(text)
    assert not is_farewell(text)


@pytest.mark.parametrize(
    "text",
    [
        "bye",
        "Goodbye!",
        "see you later",
        "bye-bye",
        "Good night",
        "I have to go",
        "i must go to bed",
        "i need to go now",
        "take care!",
        "Tschüss",
        "thanks, bye",
        "ok bye",
        "Thanks. Bye!",
        "Okay, thank you very much for your help, goodbye!",
        "Thank you so much, bye",
        "Thanks a lot bye",
        "Great, goodbye",
        "Anyway, I have to go",
    ],
)
def test_a_farewell_takes_leave_and_does_not_greet(text: str) -> None:
    assert is_farewell(text)
    assert not is_greeting(text)


@pytest.mark.parametrize(
    "text",
    [
        "",
        "hello, can you tell me what time it is",
        "hi, how are you?",
        "history is fun",
        "highway",
        "say hello to your mother",
        "byebug is a debugger, I think so",
        "I said goodbye",
        "take care of your mother",
        "I have to go to work",
        "i must go shopping",
        "farewell party tonight",
        "thanks for the good bye-laws of the club, which I read",
        "ok, I said goodbye to her",
        "Thanks for the goodbye card",
        "thank you for the good night kiss",
        "thanks" + " so" * 3000 + " x",
        "thank you for " * 3000,
        "🙂",
        "شكرا",
    ],
)
def test_what_says_more_is_left_to_others(text: str) -> None:
    assert not is_greeting(text)
    assert not is_farewell(text)


@pytest.mark.parametrize(
    "text",
    ["Thank you so much goodbye", "Thanks a lot bye", "Great goodbye", "Anyway I have to go", "ok, so long"],
)
def test_whoever_takes_leave_is_left_in_peace(text: str) -> None:
    assert takes_leave(text)  # or the agent would be bored of a user who is gone
