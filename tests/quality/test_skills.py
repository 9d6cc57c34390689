"""The skills understand the sentences of their sets as well as they did."""

from __future__ import annotations

from collections import Counter

import pytest

from quality import blind, followups, measure, skills
from quality.modules import plain
from ravestate.modules.skill.agentqa.life_file import read_life


@pytest.mark.parametrize("name", skills.SETS)
def test_the_share_right_stays_above_the_floor(name: str) -> None:
    result = skills.result(name)
    misses = "\n  ".join(result.misses)
    print(f"{name}: {result.shares['right']:.1%} of {result.cases}\n  {misses}")
    assert result.shares["right"] >= skills.FLOORS[name], misses


def test_told_facts_are_stored_and_nothing_wrong() -> None:
    _, told, tricky = blind.measured_facts("../told_rows")
    assert told.shares["right"] >= 0.86
    assert tricky.shares["nothing wrong"] >= 0.95


@pytest.mark.parametrize("name", skills.SETS)
def test_no_sentence_stands_twice(name: str) -> None:
    counts = Counter(text for text, _ in measure.labelled(name))
    assert [text for text, count in counts.items() if count > 1] == []


def test_distress_is_never_missed() -> None:
    cases = [case for case in measure.labelled("agentqa_remarks") if case[1] == "distress"]
    assert len(cases) >= 15
    assert measure.measure_labels("distress", skills.agentqa_remarks, cases).misses == []


def test_no_question_to_the_agent_is_one_of_its_examples() -> None:
    life = read_life()
    examples = {plain(question) for topic in life.topics.values() for question in topic.questions}
    examples |= set(map(plain, life.others))
    assert examples.isdisjoint(plain(text) for text, _ in measure.labelled("agentqa_asks"))


def test_follow_ups_are_answered_above_the_floor() -> None:
    result = followups.measure_followups(every=4)
    assert result.shares["right"] >= 0.90, "\n  ".join(result.misses)
    assert result.shares["wrong"] <= 0.03, "\n  ".join(result.misses)
