"""`recognise` finds a feeling in a sentence. `tests/quality` measures how well it recognises feelings."""

import pytest

from ravestate.language.acts import acts, heard
from ravestate.language.bundled import ModelMissing
from ravestate.language.feelings import feelings
from ravestate.language.matcher import Matcher, bundled_matcher
from ravestate.modules import emotion
from ravestate.modules.modality.emotion import recogniser
from ravestate.modules.modality.emotion.recogniser import recognise


def test_a_sentence_about_the_agents_name_means_the_agent() -> None:
    assert recognise("Rosie is so clever!", ["Rosie"]) == recognise("You are so clever!") == "shy"
    assert recognise("Rosie is so clever!", ["Ada"]) is None


@pytest.mark.parametrize(
    "text",
    [
        "", "   ", "?", "...", "!!!", "\x00\x07", "\ud800", "مرحبا بك", "Der Zug fährt um neun.",
        "you " * 50_000, "a" * 100_000, "?!" * 20_000 + "x", "so very really " * 10_000,
    ],
)  # fmt: skip
def test_recognise_accepts_any_text(text: str) -> None:
    assert recognise(text) in (None, "surprised", "happy", "affectionate")


@pytest.mark.parametrize("frame", ["{}?", "If {}, I would stay.", "It is not true that {}."])
def test_a_question_a_condition_or_a_denial_raises_no_feeling(frame: str) -> None:
    for praise in ("you are nice", "you are so clever"):
        assert recognise(praise) == "shy"
        assert recognise(frame.format(praise)) is None
    assert recognise("The weather is nice.") is None


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
