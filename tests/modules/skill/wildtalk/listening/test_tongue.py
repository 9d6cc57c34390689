"""Utterances that are not English."""

import pytest

from ravestate.language.nonsense import is_nonsense
from ravestate.modules.skill.wildtalk.listening.material import material
from ravestate.modules.skill.wildtalk.listening.tongue import is_number, tongue_of


@pytest.mark.parametrize(
    ("text", "tongue"),
    [
        ("ich habe keine Ahnung und du", "de"), ("hola, qué tal", "es"), ("je suis très content", "fr"),
        ("здравствуйте", "?"), ("你好吗", "?"),
        ("I am fine", ""), ("hello my friend", ""), ("no", ""), ("pizza con carne", ""), ("", ""), ("die hard", ""),
    ],
)  # fmt: skip
def test_the_language_of_an_utterance_is_recognised(text: str, tongue: str) -> None:
    assert tongue_of(text, material().tongues) == tongue


@pytest.mark.parametrize(
    ("text", "nonsense"),
    [
        ("asdfgh", True), ("qwertz uiop", True), ("aaaaaaa", True), ("xkcdbwq", True),
        ("hello", False), ("strengths", False), ("rhythm", False), ("I see", False), ("", False), ("hmm", False),
    ],
)  # fmt: skip
def test_nonsense_is_recognised(text: str, nonsense: bool) -> None:
    assert is_nonsense(text) is nonsense


def test_only_an_utterance_of_digits_counts_as_a_number() -> None:
    assert is_number("42!")
    assert not is_number("four")
    assert not is_number("!")
