"""The user corrects or questions the agent's last answer."""

from typing import Any

import pytest

from modules.skill.wildtalk.listening.conftest import seen
from ravestate.modules.skill.wildtalk.listening.material import material
from ravestate.modules.skill.wildtalk.listening.repair import repair_in
from ravestate.modules.skill.wildtalk.listening.state import State

SAID = State(said=("The tide turns twice a day.",), before="our ferry to the island was cancelled")


@pytest.mark.parametrize(
    ("text", "kind", "again"),
    [
        ("no, i meant who pays for the hotel now", "meant", "who pays for the hotel now"),
        ("what? I was talking about the ferry", "meant", "our ferry to the island was cancelled"),
        ("what have tides to do with my ferry?", "puzzled", ""),
        ("turns where? whatever. where can we sleep tonight?", "puzzled", "Where can we sleep tonight?"),
        ("you already told me that", "repeated", ""),
        ("why? we only wanted a quiet weekend", "why", "We only wanted a quiet weekend."),
    ],
)
def test_a_correction_is_recognised_with_the_words_that_the_user_meant(text: str, kind: str, again: str) -> None:
    found = repair_in(seen(text), SAID)
    assert found is not None
    assert found.kind == kind
    assert again.lower().rstrip(".") in found.again.lower()


@pytest.mark.parametrize(
    "text",
    [
        "I asked a sailor and he laughed",
        "I was talking to my aunt about it yesterday",
        "I mean, it is good that nobody was hurt",
        "I said yes to him",
        "which ferry do you recommend?",
        "I meant to write to you",
    ],
)
def test_a_report_of_a_conversation_is_not_a_correction(text: str) -> None:
    assert repair_in(seen(text), SAID) is None


def test_after_a_correction_the_listener_admits_its_mistake_and_answers(talk: Any) -> None:
    talk.say("my garden is full of slugs")
    answer = talk.say("no, I meant how do I fall asleep faster")
    assert any(answer.startswith(line.text) for line in material().plain["repair"].groups["meant"])
    assert len(answer.split()) > 8
