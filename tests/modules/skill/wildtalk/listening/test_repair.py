"""The user corrects or questions the agent's last answer. The quality set ``repairs_rows`` has more sentences."""

from typing import Any

import pytest

from modules.skill.wildtalk.listening.conftest import seen
from ravestate.modules.skill.wildtalk.listening.material import material
from ravestate.modules.skill.wildtalk.listening.repair import repair_in
from ravestate.modules.skill.wildtalk.listening.state import State

SAID = State(said=("The tide turns twice a day.",), before="our ferry to the island was cancelled")


@pytest.mark.parametrize("meant", ["who pays for the hotel now", "how do I get there", "where can we sleep"])
def test_what_the_user_meant_is_answered_and_a_report_is_not(meant: str) -> None:
    found = repair_in(seen(f"no, I meant {meant}"), SAID)
    assert found is not None
    assert (found.kind, found.again.lower().rstrip(".?")) == ("meant", meant.lower())
    assert repair_in(seen(f"my aunt asked {meant}"), SAID) is None


def test_without_an_answer_of_the_agent_there_is_nothing_to_repair() -> None:
    assert repair_in(seen("no, I meant the hotel"), State()) is None


def test_after_a_correction_the_listener_admits_its_mistake_and_answers(talk: Any) -> None:
    talk.say("my garden is full of slugs")
    answer = talk.say("no, I meant how do I fall asleep faster")
    assert any(answer.startswith(line.text) for line in material().plain["repair"].groups["meant"])
    assert len(answer.split()) > 8
