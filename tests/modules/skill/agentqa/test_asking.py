"""Sentences that ask something about the agent, found by pronouns, word order and polite phrases."""

from __future__ import annotations

import pytest

from ravestate.modules.skill.agentqa.asking import LONGEST, SENTENCES, about_agent


def asked(utterance: str, **more: bool) -> list[str]:
    return [one.text for one in about_agent(utterance, ("Ravestate",), **more)[0]]


@pytest.mark.parametrize(
    ("said", "why"),
    [
        ("what is my name", "about the user"),
        ("you are nice", "not a question"),
        ("?!", "nothing is said"),
        ("is he your father", "about somebody else"),
        ("why do you like music", "asks for a reason"),
        ("what do " + "you " * 40, "longer"),
    ],
)
def test_other_sentences_are_left_out_with_a_reason(said: str, why: str) -> None:
    found, reason = about_agent(said)
    assert found == [] and why in reason


def test_that_it_is_a_question_may_be_known_from_elsewhere() -> None:
    assert asked("you live where") == []
    assert asked("you live where", question=True) == ["you live where"]


def test_a_known_question_counts_in_any_form() -> None:
    known = {"with whom do i have the pleasure"}
    assert about_agent("With whom do I have the pleasure?", (), known)[0]
    assert not about_agent("With whom do I have the pleasure?")[0]


def test_questions_are_kept_and_statements_dropped() -> None:
    assert asked("Hello! My father is a baker. Who is your father? I wonder.") == ["who is your father"]


def test_whether_somebody_is_addressed_is_told() -> None:
    [there], [not_there] = about_agent("how are you")[0], about_agent("how is it going")[0]
    assert there.addressed and not not_there.addressed


def test_only_the_beginning_of_a_long_text_is_looked_at() -> None:
    assert asked("How old are you? " * 10_000) == ["how old are you"] * SENTENCES
    assert asked("x" * LONGEST + "? How old are you?") == []
    assert asked("you " * 50_000) == []
