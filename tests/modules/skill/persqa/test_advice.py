"""Questions for advice, opinions and favours."""

import pytest

from ravestate.modules.skill.persqa.advice import asks_for_advice, may_ask_for_help


@pytest.mark.parametrize(
    ("text", "advice", "help_"),
    [
        ("how do I ask her?", True, True),
        ("What should I wear?", True, True),
        ("what ought we to say?", True, True),
        ("do you think so?", True, True),
        ("can you call me?", False, True),
        ("what do I need?", False, True),
        ("what may I not eat?", False, False),
        ("do you remember my name?", False, False),
        ("can you still tell what I said?", False, False),
        ("what is my dog called?", False, False),
    ],
)
def test_questions_for_advice_and_for_help_are_recognised(text: str, advice: bool, help_: bool) -> None:
    assert (asks_for_advice(text), may_ask_for_help(text)) == (advice, help_)
