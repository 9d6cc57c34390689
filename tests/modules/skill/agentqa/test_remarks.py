"""Properties that hold for any remark. The quality set ``agentqa_remarks`` measures how well remarks are understood."""

from __future__ import annotations

import pytest

from ravestate.language.matcher import bundled_matcher
from ravestate.modules.meta.nlp.analysis import MATCHERS, analyse
from ravestate.modules.meta.nlp.pipeline import pipeline
from ravestate.modules.skill.agentqa import Life, Topic, read_life
from ravestate.modules.skill.agentqa.remarks import act_in, remark_in


@pytest.mark.parametrize("text", ["", "😀", "x" * 100_000, "you are " * 50_000, "i feel so so so " * 20_000])
def test_neither_an_empty_nor_a_very_long_text_is_a_remark(text: str) -> None:
    assert remark_in(text, read_life()) is None


def test_a_remark_can_call_the_agent_by_its_name() -> None:
    life = read_life()
    rude = Topic("rude", (), ("Hm.",), remarks=("you are rude",))
    life = Life(life.facts, {**life.topics, "rude": rude})
    assert remark_in("Robin is rude", life) is None
    found = remark_in("Robin is rude", life, ["Robin"])
    assert found is not None and found.topic == "rude"


def test_each_expression_of_a_topic_has_groups_of_its_own() -> None:
    life = read_life()
    parrot = Topic("parrot", (), ("Hm.",), remarks=(r"(?P<who>polly) .*", r"(\w+) \1", "(?P<who>cracker)"))
    life = Life(life.facts, {"parrot": parrot})
    assert [bool(remark_in(said, life)) for said in ("Polly wants", "blah blah", "cracker", "blah")] == [1, 1, 1, 0]


def test_the_gravest_of_several_remarks_counts() -> None:
    found = remark_in("You are stupid. My cat died. I want to die.", read_life())
    assert found is not None and (found.topic, found.text) == ("distress", "i want to die")


def test_a_mild_insult_beside_a_question_is_ignored_unless_it_names_the_agent() -> None:
    for name in MATCHERS:
        bundled_matcher(name).load()
    life = read_life()
    assert act_in(analyse("useless. how much salt for 1 l of soup", pipeline("")), life) is None
    assert act_in(analyse("you are useless. how much salt?", pipeline("")), life) is not None
