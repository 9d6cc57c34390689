"""`recognise` finds a feeling in a sentence. `tests/quality` measures how well it recognises feelings."""

import pytest

from ravestate.language.acts import acts, heard
from ravestate.language.bundled import ModelMissing
from ravestate.language.feelings import feelings
from ravestate.language.matcher import Matcher, bundled_matcher
from ravestate.modules import emotion
from ravestate.modules.modality.emotion import recogniser
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
def test_a_sentence_about_the_agents_name_raises_a_feeling(sentence: str, feeling: str | None) -> None:
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
def test_recognise_accepts_any_text(text: str) -> None:
    assert recognise(text) in (None, "surprised", "happy", "affectionate")


@pytest.mark.parametrize(
    ("text", "feeling"),
    [
        ("You are not nice.", None),
        ("if you were nice, I would stay", None),
        ("are you nice?", None),
        ("the weather is nice", None),
        ("my sister is so clever", None),
        ("You are not clever, but you are very nice.", "shy"),
        ("I got my results, and I failed", None),
        ("I love you, you are so clever", "affectionate"),
        ("My dog died.", "sad"),
        ("🎉🎉", "happy"),
    ],
)
def test_recognise_gives_the_results_that_the_readme_shows(text: str, feeling: str | None) -> None:
    assert recognise(text) == feeling


def test_without_the_encoder_recognise_accepts_only_its_examples_and_raises_an_error_for_other_texts(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    class Missing(Matcher):
        def load(self) -> None:
            raise ModelMissing("pip install it")

    without = Missing({"affection": ["I love you"]}, ["hello"])
    monkeypatch.setattr(recogniser, "bundled_matcher", lambda _: without)
    monkeypatch.setattr("ravestate.language.feelings.bundled_matcher", lambda _: without)
    assert recognise("I love you!") == "affectionate"
    assert recognise("Hello.") is None
    with pytest.raises(ModelMissing, match="pip install it"):
        recognise("I like you.")


def test_the_package_exports_recognise() -> None:
    assert emotion.recognise("I love you.") == "affectionate"


@pytest.mark.parametrize(
    "text", ["aww, you poor computer", "Bad. My chest aches when I laugh.", "Is that not hard for you?"]
)
def test_sympathy_and_complaints_are_not_recognised_as_insults(text: str) -> None:
    said = heard(text)
    bundled_matcher("acts").load()
    bundled_matcher("feelings").load()
    assert "insult" not in {**acts(said), **feelings(said)}
