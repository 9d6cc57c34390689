"""The words around a value tell its topic, although neither the table nor an example has the sentence."""

from __future__ import annotations

import pytest

from quality.blind import stored


@pytest.mark.parametrize(
    ("sentence", "fact"),
    [
        ("I am passionate about jazz", "liking=jazz"),
        ("I was hired by the railway", "employer=the railway"),
        ("the railway has employed me since May", "employer=the railway"),
    ],
)
def test_words_in_no_table_tell_the_topic(sentence: str, fact: str) -> None:
    assert fact in stored(sentence)


@pytest.mark.parametrize(
    "sentence",
    [
        "I got lost in Sousse",
        "I am waiting for marzipan",
        "the railway has annoyed me since May",
        "I run a flower shop",
    ],
)
def test_words_that_tell_no_topic_tell_none(sentence: str) -> None:
    assert not any("=" in one for one in stored(sentence))
