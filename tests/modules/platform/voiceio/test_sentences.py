"""Sentences are taken from a growing text as soon as they are complete."""

from ravestate.modules.platform.voiceio.sentences import sentences, speakable


def test_a_sentence_is_complete_when_another_begins() -> None:
    assert list(sentences("Once there was a robot.", whole=False)) == []
    assert list(sentences("Once there was a robot. It", whole=False)) == [(0, "Once there was a robot.")]
    assert list(sentences("Once there was a robot. It", whole=True)) == [(0, "Once there was a robot."), (23, " It")]


def test_a_short_first_sentence_is_joined_with_the_next_sentence() -> None:
    assert list(sentences("Oh. I see what you mean. Go on", whole=False)) == [(0, "Oh. I see what you mean.")]


def test_an_abbreviation_does_not_end_a_sentence() -> None:
    assert list(sentences("I have met Dr. Miller yesterday. And", whole=False)) == [
        (0, "I have met Dr. Miller yesterday.")
    ]


def test_the_joined_sentences_equal_the_whole_text() -> None:
    text = "One thing is sure! What else?\nA list: a, b. And an end"
    assert "".join(sentence for _, sentence in sentences(text, whole=True)) == text


def test_each_emoji_and_each_formatting_mark_becomes_a_space() -> None:
    assert speakable("*Hi* there 😊!") == " Hi  there  !"
    assert speakable("😊 …") == ""


def test_chinese_and_japanese_sentences_end_without_a_space() -> None:
    text = "从前有一个机器人，它住在博物馆里。有一天晚上，它听到了奇怪的声音！“那是什么？”它"
    assert [sentence for _, sentence in sentences(text, whole=False)] == [
        "从前有一个机器人，它住在博物馆里。",
        "有一天晚上，它听到了奇怪的声音！",
    ]
    assert list(sentences("这是一个很长很长的句子吗？", whole=False)) == []  # a closing quotation mark can follow
    quoted = "「昔々、ロボットがいたそうです。」と彼女は静かに言いました。次"
    assert [sentence for _, sentence in sentences(quoted, whole=False)] == [
        "「昔々、ロボットがいたそうです。」",
        "と彼女は静かに言いました。",
    ]
