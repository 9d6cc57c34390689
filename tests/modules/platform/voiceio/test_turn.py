"""The agent recognises the end of a turn, back-channels, and echoes of its own words."""

import pytest

from modules.platform.voiceio.speech import spoken
from ravestate.modules.platform.voiceio import Settings
from ravestate.modules.platform.voiceio.models import smart_turn
from ravestate.modules.platform.voiceio.turn import (
    Melody,
    completeness,
    is_back_channel,
    is_echo,
    wanted_silence,
)

SETTINGS = Settings(pause=0.2, doubtful_pause=0.7, longest_pause=1.4)


@pytest.mark.parametrize(
    ("text", "complete", "silence"),
    [
        ("What time is it?", 0.9, 0.2),
        ("What time is it?", 0.3, 0.7),
        ("What time is it?", 0.1, 1.4),
        ("What time is it?", None, 0.7),
        ("I think that", 0.9, 0.7),
        ("I would like to go to the", 0.9, 1.4),
        ("I would like a coffee,", 0.9, 1.4),
        ("What would you like to go to?", 0.9, 0.2),
        ("", 0.9, 0.2),
    ],
)
def test_words_and_melody_decide_how_much_silence_ends_a_turn(
    text: str, complete: float | None, silence: float
) -> None:
    assert wanted_silence(text, complete, SETTINGS) == silence


@pytest.mark.parametrize(
    ("text", "last", "silence"),
    [
        ("It is a photograph of mine.", {"mine": 0.74, "my": 0.21}, 0.7),
        ("It is a photograph of mine.", {"mine": 0.99}, 0.2),
        ("I like apple.", {"apple": 0.2, "ap": 0.1}, 0.7),
        ("Where are you from?", {"from": 0.99}, 0.2),
        ("I am looking for a", {"a": 0.99}, 1.4),
    ],
)
def test_alternatives_for_the_last_word_change_how_much_silence_ends_a_turn(
    text: str, last: dict[str, float], silence: float
) -> None:
    assert wanted_silence(text, 0.9, SETTINGS, last) == silence


def test_the_agent_waits_for_no_silence_longer_than_the_setting() -> None:
    quick = Settings(longest_pause=0.5)
    assert max(wanted_silence(text, 0.1, quick) for text in ("and the", "Yes.", "I think that")) == 0.5


def test_completeness_and_back_channels_are_recognised_in_german() -> None:
    assert completeness("Ich möchte in die", "DE-at") == "open"
    assert completeness("Ich möchte nach Hause.", "de") == "complete"
    assert is_back_channel("Ja, genau.", "de") and not is_back_channel("Nein.", "de")


@pytest.mark.parametrize(
    "text",
    [
        "Mhm.",
        "Mm-hmm.",
        "M-H-M.",
        "M.H.N.",
        "M-A-K-M",
        "Hmm",
        "Yes.",
        "Yeah, okay.",
        "Ha ha ha!",
        "Hahaha",
        "Oh, I see.",
        "Uh-huh.",
    ],
)
def test_a_sign_of_listening_is_a_back_channel(text: str) -> None:
    assert is_back_channel(text)


@pytest.mark.parametrize(
    "text", ["No.", "Stop.", "Yes, but why?", "Wait", "How?", "", "Okay, now something else please"]
)
def test_an_interruption_is_not_a_back_channel(text: str) -> None:
    assert not is_back_channel(text)


def test_is_echo_recognises_the_agents_own_words() -> None:
    own = "Once there was a robot. It lived in a museum."
    assert is_echo("It lived in a museum.", own)
    assert is_echo("lived in the museum", own + " It lived in a")
    assert not is_echo("Where did it live?", own)
    assert not is_echo("museum", own)  # the user can ask a question with this single word


def test_the_melody_distinguishes_complete_sentences_from_unfinished_ones() -> None:
    file = smart_turn()
    assert file is not None
    melody = Melody(file)
    rest = bytes(6400)
    complete = [melody.complete(spoken(text) + rest) for text in ("What time is it?", "My name is Robert.")]
    cut = [melody.complete(spoken(text) + rest) for text in ("When I was a child, I", "Yesterday I met a man who")]
    assert min(complete) > 0.5 > max(cut)
