"""Introductions: the name that an utterance gives, and the rest of the utterance."""

import pytest

from ravestate.modules.meta.nlp.analysis import analyse
from ravestate.modules.meta.nlp.introduction import introductions_in
from ravestate.modules.meta.nlp.pipeline import Pipeline


@pytest.mark.parametrize(
    ("text", "name", "rest"),
    [
        ("my name is Ada. I had a long day", "Ada", "I had a long day."),
        ("hi im anna and my dog died yesterday", "Anna", "my dog died yesterday."),
        ("Hello! I'm Anna, nice to meet you. My dog has died.", "Anna", "My dog has died."),
        ("We moved here in May, and my name is Ada.", "Ada", "We moved here in May"),
        ("call me Tom. What do you do all day?", "Tom", "What do you do all day?"),
        ("My name is Ada from Rome. I had a long day.", "Ada", "I had a long day."),
    ],
)
def test_a_user_can_say_their_name_and_something_else(text: str, name: str, rest: str, reader: Pipeline) -> None:
    found = analyse(text, reader).introduction
    assert found is not None
    assert (found.name, found.rest) == (name, rest)


@pytest.mark.parametrize(
    "text", ["I'm Anna", "I'm tired. I had a long day.", "this is nice. i had a long day", "hello"]
)
def test_an_utterance_without_a_name_or_without_anything_else_has_no_introduction(text: str, reader: Pipeline) -> None:
    assert analyse(text, reader).introduction is None


@pytest.mark.parametrize(
    ("text", "name"),
    [
        ("it's me, Ilka", "Ilka"),
        ("Hi. This is Ilka again!", "Ilka"),
        ("ilka here", "ilka"),
        ("good evening, im ilka from ulm", "ilka"),
        ("it's Ilka by the way", "Ilka"),
    ],
)
def test_the_word_in_the_place_of_a_name_is_found(text: str, name: str, reader: Pipeline) -> None:
    assert [one.name for one in introductions_in(reader.read(text)[0])][:1] == [name]


def test_a_name_that_may_belong_to_something_else_is_marked_as_unsure(reader: Pipeline) -> None:
    (found,) = introductions_in(reader.read("my dog isn't Rex, it's Max")[0])
    assert found.pointing and found.late and not found.sure
    (found,) = introductions_in(reader.read("I'm Max")[0])
    assert not found.pointing and not found.late
