"""An introduction is a name that the user gives, and the rest of the utterance. `tests/quality` has more sentences."""

import pytest

from ravestate.modules.meta.nlp.analysis import analyse
from ravestate.modules.meta.nlp.introduction import introductions_in
from ravestate.modules.meta.nlp.pipeline import Pipeline


@pytest.mark.parametrize("name", ["Ada", "Ilka", "Thabo"])
def test_an_introduction_has_the_name_and_the_other_words_of_an_utterance(name: str, reader: Pipeline) -> None:
    for frame in ("my name is {}", "call me {}", "Hello! My name is {}"):
        found = analyse(f"{frame.format(name)}. I had a long day", reader).introduction
        assert found is not None
        assert (found.name, found.rest) == (name, "I had a long day.")
        assert analyse(frame.format(name), reader).introduction is None


@pytest.mark.parametrize("text", ["I'm tired. I had a long day.", "this is nice. i had a long day", "hello"])
def test_an_utterance_that_gives_no_name_has_no_introduction(text: str, reader: Pipeline) -> None:
    assert analyse(text, reader).introduction is None


def test_an_introduction_that_may_name_another_being_is_marked(reader: Pipeline) -> None:
    (found,) = introductions_in(reader.read("my dog isn't Rex, it's Max")[0])
    assert found.pointing and found.late and not found.sure
    (found,) = introductions_in(reader.read("I'm Max")[0])
    assert not found.pointing and not found.late
