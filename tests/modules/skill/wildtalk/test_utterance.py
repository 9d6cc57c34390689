"""`Utterance` turns the output of a model into the words of an agent."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from ravestate.modules.skill.wildtalk.utterance import Utterance


def said(*pieces: str, name: str = "Rosie", sentences: int = 2) -> str:
    utterance = Utterance(name, sentences=sentences)
    shown = "".join(utterance.feed(piece) for piece in pieces) + utterance.finish()
    assert shown == utterance.text
    return shown


@pytest.mark.parametrize(
    ("written", "expected"),
    [
        ("Hello there!", "Hello there!"),
        ("  Hello\n\n there! \n", "Hello there!"),
        ("Rosie: Hello!", "Hello!"),
        ('"Hello!"', "Hello!"),
        ('"Hello!" she said.', 'Hello!" she said.'),
        ('Rosie: "Hello!"', "Hello!"),
        ("Assistant: Hello!", "Hello!"),
        ("Hello!\nUser: Who are you?", "Hello!"),
        ("Hello! Human: Who are you?", "Hello!"),
        ("Hello!\nRosie: And again", "Hello!"),
        ("Hello!<|im_end|>\n<|im_start|>user", "Hello!"),
        ("Hello!</s>", "Hello!"),
        ("Hello!\n### Instruction", "Hello!"),
        ("<think>He greets. I greet.</think>\n\nHello!", "Hello!"),
        ("<think>He greets, and I", ""),
        ("One. Two! Three?", "One. Two!"),
        ("One... two. Three. Four.", "One... two. Three."),
        ("I met Dr. Who. He is nice. He left.", "I met Dr. Who. He is nice."),
        ("Pi is 3.14 or so. Yes. No.", "Pi is 3.14 or so. Yes."),
        ("Hi! 😊 How are you? Fine?", "Hi! How are you?"),
        ("Bots are fun, and so is AI.", "Bots are fun, and so is AI."),
        ("Red\x1b \x00and\x07 blue\ud800", "Red and blue�"),
        ("User: Hello!", ""),
        ("", ""),
        ("👍🏽👍🏽👍🏽", "👍"),
        ("Fine ❤️👨‍👩‍👧!", "Fine !"),
    ],
)
def test_the_words_to_say_are_the_cleaned_output_of_the_model(written: str, expected: str) -> None:
    assert said(written) == expected
    assert said(*written) == expected


def test_the_first_words_are_returned_immediately() -> None:
    assert Utterance("Rosie").feed("Hello") == "Hello"


def test_the_possible_beginning_of_a_mark_is_held_back() -> None:
    utterance = Utterance("Rosie")
    assert utterance.feed("Hello Us") == "Hello"
    assert utterance.feed("ually") == " Usually"
    assert utterance.feed(" <") == ""
    assert utterance.feed("3") == ""
    assert utterance.finish() == " <3"


def test_an_utterance_is_complete_after_the_maximum_number_of_sentences() -> None:
    utterance = Utterance("Rosie", sentences=1)
    utterance.feed("Hello!")
    assert not utterance.complete  # it may still become "Hello!!!"
    utterance.feed(" How")
    assert utterance.complete
    assert utterance.feed("ever") == utterance.finish() == ""
    assert utterance.text == "Hello!"


@pytest.mark.parametrize(("written", "worth"), [("", False), ('"..." -', False), ("😊", True), ("a", True)])
def test_only_text_with_words_or_emoji_is_worth_saying(written: str, worth: bool) -> None:
    utterance = Utterance("Rosie")
    utterance.feed(written)
    utterance.finish()
    assert utterance.worth_saying() is worth


def test_a_maximum_of_zero_sentences_is_refused() -> None:
    with pytest.raises(ValueError, match="at least 1, not 0"):
        Utterance("Rosie", sentences=0)


PARTS = st.sampled_from(
    [*'Us er:<|im_end|>.!?"“(#[\n\t \x00', "User:", "Rosie:", "</s>", "<think>", "</think>", "Dr. ", "Yes. No. ", "[INST]", "### ", "Ros", "<|eot_id|>", "hello "]
)  # fmt: skip


@given(st.lists(PARTS, max_size=30), st.data())
def test_the_pieces_of_an_output_do_not_change_its_words(parts: list[str], data: st.DataObject) -> None:
    written = "".join(parts)
    whole = said(written)
    assert said(*parts) == whole
    assert said(*written) == whole
    place = data.draw(st.integers(0, len(written)))
    assert said(written[:place], written[place:]) == whole
    assert "  " not in whole
    assert whole == whole.strip()
