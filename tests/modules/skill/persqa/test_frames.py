"""The words around a value show its topic, even in a sentence that is in no table and no example."""

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
def test_the_topic_of_a_value_is_found_in_a_sentence_that_is_in_no_table(sentence: str, fact: str) -> None:
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
def test_a_sentence_without_a_topic_gives_no_fact(sentence: str) -> None:
    assert not any("=" in one for one in stored(sentence))
