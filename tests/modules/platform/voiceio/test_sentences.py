"""Sentences are taken from a growing text as soon as they are complete."""

from ravestate.modules.platform.voiceio.sentences import sentences, speakable


def test_a_sentence_is_complete_when_another_begins() -> None:
    assert list(sentences("Once there was a robot.", whole=False)) == []
    assert list(sentences("Once there was a robot. It", whole=False)) == [(0, "Once there was a robot.")]
    assert list(sentences("Once there was a robot. It", whole=True)) == [(0, "Once there was a robot."), (23, " It")]


def test_a_short_beginning_is_spoken_with_the_next_sentence() -> None:
    assert list(sentences("Oh. I see what you mean. Go on", whole=False)) == [(0, "Oh. I see what you mean.")]


def test_an_abbreviation_ends_no_sentence() -> None:
    assert list(sentences("I have met Dr. Miller yesterday. And", whole=False)) == [
        (0, "I have met Dr. Miller yesterday.")
    ]


def test_the_parts_make_the_whole() -> None:
    text = "One thing is sure! What else?\nA list: a, b. And an end"
    assert "".join(sentence for _, sentence in sentences(text, whole=True)) == text


def test_emoji_and_marks_are_not_spoken_and_places_stay() -> None:
    assert speakable("*Hi* there 😊!") == " Hi  there  !"
    assert speakable("😊 …") == ""
