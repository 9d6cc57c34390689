"""Utterances that are no English. The quality set ``tongues_rows`` has more of them."""

from quality.measure import labelled
from ravestate.language.nonsense import is_nonsense
from ravestate.modules.skill.wildtalk.listening.material import material
from ravestate.modules.skill.wildtalk.listening.tongue import is_number, tongue_of


def test_words_of_each_tongue_are_recognised_and_english_is_not() -> None:
    tongues = material().tongues
    for name, words in tongues.items():
        assert tongue_of(" ".join(sorted(words)[:6]), tongues) == name
    assert [tongue_of(text, tongues) for text in ("", "no", "die hard", "pizza con carne", "你好吗")] == [
        "",
        "",
        "",
        "",
        "?",
    ]


def test_english_words_are_no_nonsense() -> None:
    assert [text for text, _ in labelled("emotion_rows") if text.isascii() and is_nonsense(text)] == []
    assert is_nonsense("asdfgh")


def test_only_an_utterance_of_digits_counts_as_a_number() -> None:
    assert is_number("42!")
    assert not is_number("four")
    assert not is_number("!")
