"""Properties of any remark. The quality set ``agentqa_remarks`` measures how well remarks are understood."""

from __future__ import annotations

import pytest

from ravestate.language.acts import acts, heard
from ravestate.language.matcher import bundled_matcher
from ravestate.modules.meta.nlp.analysis import MATCHERS, analyse
from ravestate.modules.meta.nlp.pipeline import pipeline
from ravestate.modules.skill.agentqa import Life, Router, Topic, read_life
from ravestate.modules.skill.agentqa.remarks import act_in, remark_in
from ravestate.modules.skill.agentqa.router import Miss


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


def test_the_gravest_of_several_remarks_counts() -> None:
    found = remark_in("You are stupid. My cat died. I want to die.", read_life())
    assert found is not None and (found.topic, found.text) == ("distress", "i want to die")


@pytest.mark.parametrize("text", ["please don't stay silent", "do not shut up, I like it", "I never told you to hush"])
def test_the_opposite_of_a_wish_for_quiet_is_not_taken_for_such_a_wish(text: str) -> None:
    bundled_matcher("acts").load()
    assert "quiet" not in acts(heard(text))


@pytest.mark.parametrize(
    "text", ["please don't disturb me now", "do not say one more word to me", "I asked you to be silent"]
)
def test_a_wish_for_quiet_can_contain_a_negation(text: str) -> None:
    bundled_matcher("acts").load()
    assert "quiet" in acts(heard(text))


def test_a_mild_insult_beside_a_question_is_ignored_unless_it_names_the_agent() -> None:
    for name in MATCHERS:
        bundled_matcher(name).load()
    life = read_life()
    assert act_in(analyse("useless. how much salt for 1 l of soup", pipeline("")), life) is None
    assert act_in(analyse("you are useless. how much salt?", pipeline("")), life) is not None


@pytest.mark.parametrize("text", ["ok. bus 12 or 15 for the station?", "okay okay. who would be king of the moon?"])
def test_a_question_that_begins_with_okay_is_not_taken_for_how_are_you(router: Router, text: str) -> None:
    assert isinstance(router.route(text, question=True), Miss)
