"""Properties that hold for any question. The quality set ``genqa_declined`` measures which questions are looked up."""

import pytest

from ravestate.modules.skill.genqa.question import as_question


@pytest.mark.parametrize(
    ("heard", "reason"),
    [
        ("What is your name?", "it is about the user or the agent"),
        ("What time is it?", "moment"),
        ("Should people eat meat?", "it asks for an opinion"),
        ("What is it?", "it has no word to look for"),
        ("\x00\x1b[2J", "it has no word to look for"),
        ("what is rain " * 10_000, "it is too long for a question"),
    ],
)
def test_a_question_that_no_document_can_answer_is_declined_with_a_reason(heard: str, reason: str) -> None:
    assert reason in as_question(heard).declined


@pytest.mark.parametrize("heard", ["ما هي عاصمة بيرو؟", "Peru？", 'a" OR title:b* NEAR(c)', "what is \udce9rain"])
def test_words_are_found_in_any_script_and_next_to_any_punctuation(heard: str) -> None:
    question = as_question(heard)
    assert question.words
    assert all(word.isalnum() for word in question.words)
