"""Greeting, leaving, playing."""

import pytest

from ravestate.modules.meta.nlp.intents import says_bye, says_hi, wants_to_play


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
     "it was nice talking to you", "well, until next time", "bye ravestate", "Have a nice day!", "talk to you later"],
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


@pytest.mark.parametrize(
    "text",
    ["let's play a game", "do you want to play with me", "Can we play chess?", "I want to play", "play a game with me",
     "wanna play", "how about a game", "shall we play something", "I would like to play a game", "let's play",
     "why don't we play chess?", "Don't you want to play?", "a game?"],
)  # fmt: skip
def test_proposals_to_play(text: str) -> None:
    assert wants_to_play(text)


@pytest.mark.parametrize(
    "text",
    ["", "I play the piano", "my sister plays football", "I don't want to play", "do you play chess", "play some music",
     "what do you like to play", "I like to play tennis on Sundays", "can you play the guitar", "the game was boring",
     "do you like games"],
)  # fmt: skip
def test_no_proposals_to_play(text: str) -> None:
    assert not wants_to_play(text)
