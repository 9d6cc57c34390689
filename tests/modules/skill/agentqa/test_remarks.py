"""Laws for any remark. The set ``agentqa_remarks`` measures how well remarks are understood."""

from __future__ import annotations

import pytest

from ravestate.modules.skill.agentqa import Life, Topic, read_life
from ravestate.modules.skill.agentqa.remarks import remark_in


@pytest.mark.parametrize("text", ["", "😀", "x" * 100_000, "you are " * 50_000, "i feel so so so " * 20_000])
def test_long_texts_and_none_at_all_are_no_remarks(text: str) -> None:
    assert remark_in(text, read_life()) is None


def test_the_agent_may_be_called_by_its_name() -> None:
    life = read_life()
    rude = Topic("rude", (), ("Hm.",), remarks=("you are rude",))
    life = Life(life.facts, {**life.topics, "rude": rude})
    assert remark_in("Robin is rude", life) is None
    found = remark_in("Robin is rude", life, ["Robin"])
    assert found is not None and found.topic == "rude"


def test_the_gravest_of_several_remarks_counts() -> None:
    found = remark_in("You are stupid. My cat died. I want to die.", read_life())
    assert found is not None and (found.topic, found.text) == ("distress", "i want to die")
