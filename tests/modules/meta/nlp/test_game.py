"""Proposals to play."""

import pytest

from ravestate.modules.meta.nlp.game import wants_to_play


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
