"""The laws of `recognise`; `tests/quality` measures which texts show which feeling."""

import sys

import pytest

from ravestate.errors import PlatformError
from ravestate.modules import emotion
from ravestate.modules.modality.emotion import sentiment
from ravestate.modules.modality.emotion.recogniser import recognise


@pytest.mark.parametrize(
    ("sentence", "feeling"),
    [
        ("Rosie is so clever!", "shy"),
        ("Rosie's voice is lovely", "shy"),
        ("rosie's so cute", "shy"),
        ("I love Rosie.", "affectionate"),
        ("Rosie isn't nice.", None),
        ("Rosalie is so clever!", None),
        ("This robot is amazing.", "shy"),
    ],
)
def test_the_agent_is_known_by_its_names(sentence: str, feeling: str | None) -> None:
    assert recognise(sentence, ["Rosie"]) == feeling


@pytest.mark.parametrize(
    "text",
    [
        "",
        "   ",
        "?",
        "...",
        "!!!",
        "\x00\x07",
        "\ud800",
        "مرحبا بك",
        "Der Zug fährt um neun.",
        "you " * 50_000,
        "a" * 100_000,
        "?!" * 20_000 + "x",
        "so very really " * 10_000,
    ],
)
def test_any_text_is_taken(text: str) -> None:
    assert recognise(text) in (None, "surprised")


def test_without_vader_it_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    sentiment._analyser.cache_clear()
    monkeypatch.setitem(sys.modules, "vaderSentiment.vaderSentiment", None)
    with pytest.raises(PlatformError, match=r"pip install 'ravestate\[emotion\]'"):
        recognise("You are so clever!")


def test_the_package_offers_it() -> None:
    assert emotion.recognise("I love you.") == "affectionate"
