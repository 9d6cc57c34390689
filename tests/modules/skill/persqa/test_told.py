"""Free statements: remembered, answered, picked up, forgotten."""

from __future__ import annotations

import itertools
from pathlib import Path

import pytest

from modules.skill.persqa.conftest import Look
from modules.skill.persqa.test_scenarios import agent, answers, knower, meant
from ravestate.modules import ontology, persqa

pytestmark = pytest.mark.usefixtures("reader")

TOLD = [
    ("Jonas plays the violin", "what does Jonas play?", "Jonas plays the violin"),
    ("I painted a dragon", "what did I paint?", "you painted a dragon"),
    ("my sister Rosa lives in Antwerp", "where does my sister live?", "your sister Rosa lives in Antwerp"),
    ("my mother works at a school", "where does my mother work?", "your mother works at a school"),
]


@pytest.mark.parametrize(("told", "question", "answer"), TOLD, ids=[told for told, _, _ in TOLD])
def test_a_free_statement_is_answered_now_and_another_day(file: Path, told: str, question: str, answer: str) -> None:
    with agent(file, knower()) as sim:
        assert answer not in answers(sim, question)
        sim.say("my name is ada")
        sim.say(told)
        assert answer in answers(sim, question)
    with agent(file, knower()) as sim:
        sim.say("my name is ada")
        assert answer in answers(sim, question)
        assert sim.failures == []


def test_it_is_kept_with_the_speaker_and_the_moment(file: Path) -> None:
    with agent(file) as sim:
        sim.say("my name is ada")
        assert answers(sim, "Jonas plays the violin") == "I see."  # small talk answers
        [one] = dict(sim.read(persqa.told)).values()
        assert (one.subject, one.verb, one.object, one.by) == ("Jonas", "play", "violin", "Ada")
        memory = sim.read(ontology.memory)
        assert memory is not None and one.at is not None
        [remark] = memory.find("Remark").result(20)
        assert remark["wording"] == "Jonas plays the violin" and remark["said_at"] == one.at


def test_it_lasts_for_the_conversation_without_a_name(file: Path, look: Look) -> None:
    with agent(file) as sim:
        sim.say("I painted a dragon")
        assert "you painted a dragon" in answers(sim, "what did I paint?")
        sim.say("my name is ada")
    assert look() == {"Ada": {"has_told": ["you painted a dragon"]}}


def test_the_agent_comes_back_to_it_before_it_asks_for_facts(file: Path) -> None:
    with agent(file) as sim:
        sim.say("my name is ada")
        sim.say("my mother is ill")
        sim.advance(6.0)
        assert meant(sim.said[-1], "how_is") and "your mother" in sim.said[-1]
        sim.say("she is better")
        sim.advance(6.0)
        assert meant(sim.said[-1], "ask_home")


def test_two_questions_for_facts_never_follow_each_other(file: Path) -> None:
    with agent(file) as sim:
        formal: list[bool] = []
        for _ in range(8):
            before = len(sim.said)
            sim.advance(6.0)
            if len(sim.said) > before:
                formal.append(sim.read(persqa.talk).formal)
            sim.say("hm, well.")
        assert formal.count(True) >= 2
        assert not any(one and other for one, other in itertools.pairwise(formal))


@pytest.mark.parametrize("text", ["forget Jonas", "forget that Jonas plays the violin"])
def test_a_free_statement_can_be_forgotten(file: Path, look: Look, text: str) -> None:
    with agent(file) as sim:
        sim.say("my name is ada")
        sim.say("Jonas plays the violin")
        assert meant(answers(sim, text), "strike")
        assert dict(sim.read(persqa.told)) == {}
    assert look() == {"Ada": {}}


def test_forgetting_a_relative_removes_the_statements_about_them(file: Path, look: Look) -> None:
    with agent(file) as sim:
        sim.say("my name is ada")
        sim.say("my sister is called Emma")
        sim.say("Emma plays the violin")
        assert meant(answers(sim, "forget my sister"), "strike")
    assert look() == {"Ada": {}}


@pytest.mark.parametrize(
    "text",
    [
        "Jonas wants to play the violin",
        "does Jonas play the violin?",
        "my friend says that Jonas plays the violin",
        "Jonas doesn't play the violin",
        "I have a question",
        "I like this song",
        "you play the violin",
        "the weather is nice",
    ],
)
def test_nothing_else_is_kept(file: Path, text: str) -> None:
    with agent(file) as sim:
        sim.say(text)
        assert dict(sim.read(persqa.told)) == {}
