"""The words around a value tell its topic, although no table and no example has them."""

from __future__ import annotations

import pytest

from quality.blind import stored


@pytest.mark.parametrize(
    ("frame", "topic"), [("I am passionate about {}", "liking"), ("I was hired by {}", "employer"), ("I entered this world in {}", "birthplace")]
)  # fmt: skip
def test_the_words_around_a_value_show_its_topic(frame: str, topic: str) -> None:
    for value in {"liking": ("jazz", "films"), "employer": ("the railway", "Bosch"), "birthplace": ("Sousse", "Ulm")}[
        topic
    ]:
        assert f"{topic}={value}".lower() in stored(frame.format(value))


@pytest.mark.parametrize("frame", ["I got lost in {}", "I am waiting for {}", "{} has annoyed me since May"])
def test_a_sentence_without_a_topic_gives_no_fact(frame: str) -> None:
    for value in ("Sousse", "marzipan", "the railway"):
        assert not any("=" in one for one in stored(frame.format(value)))
