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


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("Hello!", "greeting"),
        ("Hello, what is your name?", "greeting"),
        ("hello what is your name", "greeting"),
        ("hello is a song", ""),
        ("Thank you very much, good night!", "farewell thanks"),
        ("okay then bye", "farewell"),
        ("I have to go now", "farewell"),
        ("I have to go now to school", ""),
        ("I see you", ""),
        ("see you", "farewell"),
        ("Be quiet!", "quiet"),
        ("okay", "acknowledgement"),
        ("a byebug", ""),
        ("good morning", "greeting"),
        ("", ""),
        ("🙂", ""),
    ],
)
def test_a_short_example_can_begin_a_sentence_and_a_longer_one_must_be_the_whole_sentence(
    text: str, found: str
) -> None:
    assert " ".join(sorted(acts([text]))) == found


@pytest.mark.parametrize(
    ("act", "sentences", "alone"),
    [
        ("greeting", ["Hello!"], True),
        ("greeting", ["Hello my dear robot"], True),
        ("greeting", ["Hello, who are you?"], False),
        ("greeting", ["hello are you hungry"], False),
        ("greeting", ["hello this is a rather long sentence"], False),
        ("greeting", ["Hello!", "What is your name?"], False),
        ("greeting", ["Hello!", "Tell me a joke."], False),
        ("farewell", ["Thank you.", "Bye!"], True),
        ("farewell", ["okay, thank you, bye"], True),
        ("farewell", ["Thank you."], False),
        ("greeting", [], False),
    ],
)
def test_an_act_is_the_only_one_if_just_courtesies_and_a_few_words_surround_it(
    act: str, sentences: list[str], alone: bool
) -> None:
    assert only(act, sentences) is alone


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
