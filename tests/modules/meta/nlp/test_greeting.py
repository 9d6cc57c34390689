"""Greeting and taking leave."""

import pytest

from ravestate.modules.meta.nlp.greeting import says_bye, says_hi


@pytest.mark.parametrize(
    "text",
    [
        "hi",
        "Hello!",
        "hey there",
        "Good morning",
        "hi, how are you?",
        "oh hello",
        "Nice to meet you",
        "hiii",
        "Howdy",
    ],
)
def test_greetings(text: str) -> None:
    assert says_hi(text) and not says_bye(text)


@pytest.mark.parametrize(
    "text", ["", "high five", "I said hello", "history", "hi-fi is old", "he is here", "goodbye"]
)
def test_no_greetings(text: str) -> None:
    assert not says_hi(text)


@pytest.mark.parametrize(
    "text",
    ["bye", "Goodbye!", "ok bye bye", "thanks, see you tomorrow", "good night", "I have to go now", "see ya", "take care",
     "it was nice talking to you", "well, until next time", "bye ravestate", "Have a nice day!", "talk to you later", "bye bye see you tomorrow"],
)  # fmt: skip
def test_farewells(text: str) -> None:
    assert says_bye(text) and not says_hi(text)


@pytest.mark.parametrize(
    "text",
    ["", "I have to go to work on Mondays", "he said goodbye to his friends", "take care of the dog", "hello", "I see you",
     "I was bored yesterday", "standbye mode"],
)  # fmt: skip
def test_no_farewells(text: str) -> None:
    assert not says_bye(text)
