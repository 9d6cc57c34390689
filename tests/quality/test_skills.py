"""The skills still understand the sentences of their quality sets."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

import pytest

from quality import blind, followups, marked, measure, responses, skills, told
from quality.modules import plain
from ravestate.modules.skill.agentqa.life_file import read_life


def test_known_facts_change_only_if_the_user_says_so() -> None:
    left, changed = told.measured_changes()
    assert left.shares["right"] >= 0.88, left.misses
    assert changed.shares["right"] >= 0.9, changed.misses


@pytest.mark.parametrize("name", skills.SETS)
def test_the_share_of_right_labels_stays_above_the_floor(name: str) -> None:
    result = skills.result(name)
    misses = "\n  ".join(result.misses)
    print(f"{name}: {result.shares['right']:.1%} of {result.cases}\n  {misses}")
    assert result.shares["right"] >= skills.FLOORS[name], misses


@pytest.mark.parametrize(
    ("name", "right", "clean"),
    [
        ("told_rows", 0.87, 0.97),
        ("told_blind_rows", 0.87, 0.94),
        ("told_fresh_rows", 0.81, 0.93),
        ("told_later_rows", 0.68, 0.89),
        ("told_typed_rows", 0.70, 0.92),
        ("names_rows", 0.98, 0.95),
    ],
)
def test_facts_that_users_tell_are_stored_and_wrong_facts_are_not(name: str, right: float, clean: float) -> None:
    _, kept, tricky = blind.measured_facts(f"../{name}")
    assert kept.shares["right"] >= right
    assert tricky.shares["nothing wrong"] >= clean


def test_facts_are_understood_in_sentences_that_nobody_has_seen() -> None:
    told_facts, answers, no_fact = marked.results()
    assert told_facts.shares["right"] >= 0.82, told_facts.misses
    assert answers.shares["right"] >= 0.8, answers.misses
    assert no_fact.shares["right"] >= 0.95, no_fact.misses


def test_most_replies_that_the_listener_chooses_suit_and_few_are_wrong() -> None:
    kinds, grades = responses.results()
    print(kinds.shares, grades.shares, *kinds.misses, *grades.misses, sep="\n  ")
    assert kinds.shares["suits"] >= 0.54  # the grades choose the reply, and the kinds only help
    assert kinds.shares["wrong"] <= 0.06
    assert grades.shares["good"] >= 0.56
    assert grades.shares["bad"] <= 0.23


@pytest.mark.parametrize("name", skills.SETS)
def test_no_set_has_a_sentence_twice(name: str) -> None:
    counts = Counter(text for text, _ in measure.labelled(name))
    assert [text for text, count in counts.items() if count > 1] == []


def test_distress_is_never_missed() -> None:
    cases = [case for case in measure.labelled("agentqa_remarks") if case[1] == "distress"]
    assert len(cases) >= 15
    assert measure.measure_labels("distress", skills.agentqa_remarks, cases).misses == []


def test_the_set_agentqa_asks_has_no_example_of_agentqa() -> None:
    life = read_life()
    examples = {plain(question) for topic in life.topics.values() for question in topic.questions}
    examples |= set(map(plain, life.others))
    assert examples.isdisjoint(plain(text) for text, _ in measure.labelled("agentqa_asks"))


@pytest.mark.parametrize(("file", "every"), [(followups.ROWS, 4), (followups.SHIP, 1)])
def test_follow_ups_are_answered_above_the_floor(file: Path, every: int) -> None:
    result = followups.measure_followups(file, every)
    assert result.shares["right"] >= 0.90, "\n  ".join(result.misses)
    assert result.shares["wrong"] <= 0.03, "\n  ".join(result.misses)
