"""The question within an utterance, and which ones documents cannot know."""

import pytest

from ravestate.modules.skill.genqa.question import as_question


@pytest.mark.parametrize(
    ("heard", "words"),
    [
        ("What is the capital of Peru?", ("capital", "Peru")),
        ("what's the capital of peru", ("capital", "peru")),
        ("Hello! Can you tell me what the capital of Peru is?", ("capital", "Peru")),
        ("So, do you know who wrote Hamlet", ("wrote", "Hamlet")),
        ("I like rain. Why does it rain? I wonder.", ("rain",)),
        ("How do you make ice cream?", ("ice", "cream")),
        ("How often must I grease the pump?", ("often", "grease", "pump")),
        ("Is the US larger than us?", ("US", "larger")),
        ("Wer ist der König?", ("Wer", "ist", "der", "König")),
    ],
)
def test_the_words_that_say_what_it_is_about(heard: str, words: tuple[str, ...]) -> None:
    question = as_question(heard)
    assert question.declined == ""
    assert question.words == words


def test_words_for_the_kind_of_answer_are_kept_apart() -> None:
    question = as_question("When did Ghana become independent?")
    assert question.words == ("Ghana", "independent")
    assert question.kinds == ("When", "become")


@pytest.mark.parametrize(
    "heard",
    [
        "What is your name?", "How old are you?", "What is my name?", "Do you like games?", "Who am I?", "Where do I live?",
        "Can you sing a song?", "Tell me about yourself", "what are u doing",
    ],
)  # fmt: skip
def test_the_two_who_talk_stand_in_no_document(heard: str) -> None:
    assert as_question(heard).declined == "it is about the two who talk"


@pytest.mark.parametrize(
    "heard",
    [
        "Will it rain today?", "will it rain", "Is it raining?", "What time is it?", "What day is it today?",
        "What's the weather?", "how is the weather like", "What's in the news?", "Who won the game yesterday?",
        "What happened this week?", "Is it cold outside?",
    ],
)  # fmt: skip
def test_the_moment_stands_in_no_document(heard: str) -> None:
    assert "moment" in as_question(heard).declined


@pytest.mark.parametrize(
    "heard", ["What is the best country?", "Should people eat meat?", "Is Peru better than Chile?"]
)
def test_opinions_are_not_looked_up(heard: str) -> None:
    assert as_question(heard).declined == "it asks for an opinion"


@pytest.mark.parametrize("heard", ["", "   ", "?!?", "What is it?", "\x00\x1b[2J", "🤖🤖?"])
def test_what_has_no_word_to_look_for_is_declined(heard: str) -> None:
    assert as_question(heard).declined == "it has no word to look for"


def test_a_long_speech_is_no_question() -> None:
    assert as_question("what is rain " * 10_000).declined == "it is too long for a question"


@pytest.mark.parametrize(
    "heard", ["ما هي عاصمة بيرو؟", "Peru？", 'a" OR title:b* NEAR(c)', "what is \udce9rain"]
)
def test_any_script_and_any_mark_has_its_words(heard: str) -> None:
    question = as_question(heard)
    assert question.words
    assert all(word.isalnum() for word in question.words)
