"""Dialogue acts of the user, such as a greeting. `tests/quality` measures how many sentences are understood."""

import pytest

from ravestate.language import acts as room
from ravestate.language.acts import acts, heard, only
from ravestate.language.matcher import Matcher

EXAMPLES = {
    "greeting": ["hello", "good morning"],
    "farewell": ["bye", "good night", "see you", "I have to go now"],
    "thanks": ["thank you", "thank you very much"],
    "acknowledgement": ["okay", "good"],
    "joke": ["tell me a joke", "joke"],
    "quiet": ["be quiet"],
}


@pytest.fixture(autouse=True)
def lexicon(monkeypatch: pytest.MonkeyPatch) -> None:
    """Use a matcher that has not loaded the model, so only its exact examples are recognised."""
    matcher = Matcher(EXAMPLES, ["I stopped smoking"])
    monkeypatch.setattr(room, "bundled_matcher", lambda _: matcher)


def test_an_example_is_recognised_as_a_whole_sentence_in_any_spelling_of_capitals() -> None:
    for act, examples in EXAMPLES.items():
        for example in examples:
            assert acts([example]).keys() == acts([f"{example.upper()}!"]).keys() == {act}


def test_only_a_short_example_can_begin_a_sentence() -> None:
    assert acts(["hello what is your name"]).keys() == {"greeting"}
    assert acts(["okay then bye"]).keys() == {"farewell"}
    for text in ("hello is a song", "I have to go now to school", "I see you", "a byebug", "", "🙂"):
        assert not acts([text]), text


def test_the_function_only_returns_true_if_just_courtesies_and_a_few_words_surround_an_act() -> None:
    for act, example in (("greeting", "Hello!"), ("farewell", "Bye!")):
        assert only(act, [example]) and only(act, ["Thank you.", example])
        assert not only(act, []) and not only(act, ["Thank you."])
        assert not only(act, [example, "What is your name?"]) and not only(act, [example, "Tell me a joke."])
    assert only("greeting", ["Hello my dear robot"])
    assert not only("greeting", ["hello this is a rather long sentence"])


@pytest.mark.parametrize("text", ["x" * 1_000_000, "thank you " * 200_000, "bye " * 100_000, "," * 100_000, "شكرا"])
def test_any_text_is_handled_without_an_error(text: str) -> None:
    acts(heard(text))
    only("farewell", heard(text))


def test_each_sentence_is_matched_only_once(monkeypatch: pytest.MonkeyPatch) -> None:
    matcher = Matcher(EXAMPLES)
    matcher.load()
    runs: list[int] = []
    ranked = matcher.ranked_all
    monkeypatch.setattr(matcher, "ranked_all", lambda texts, most=None: runs.append(len(texts)) or ranked(texts, most))
    first = matcher.match_all(["Be quiet!", "Could you be quiet?"])
    assert matcher.match_all(["Could you be quiet?", "Be quiet!"]) == first[::-1]
    assert runs == [1, 0]
