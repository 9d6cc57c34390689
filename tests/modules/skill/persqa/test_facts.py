"""The agent recalls, corrects and forgets facts of every topic, and makes nothing up."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from modules.skill.persqa.conftest import Look
from modules.skill.persqa.test_scenarios import agent, answers, asked, knower, meant
from ravestate.modules import interloc, ontology, persqa
from ravestate.modules.meta.ontology.opening import open_memory

pytestmark = pytest.mark.usefixtures("reader")

TOLD: list[tuple[str, str, str]] = [
    ("I was born in Dundee", "where was I born?", "you were born in Dundee"),
    ("I am 36 years old", "how old am I?", "you are 36 years old"),
    ("I love rock climbing and baking bread", "what are my hobbies?", "you like rock climbing and baking bread"),
    ("my favourite food is pizza", "what is my favourite food?", "your favourite food is pizza"),
    ("My sister is called Emma and she lives in Vienna", "who is my sister?", "your sister is Emma"),
    ("my dog is called Rex", "what's my dog's name?", "your dog is Rex"),
    ("my friend Bob likes sailing", "what do you know about Bob?", "you are a friend of Bob"),
]  # fmt: skip


@pytest.mark.parametrize(("told", "question", "answer"), TOLD, ids=[told for told, _, _ in TOLD])
def test_a_fact_is_recalled_in_this_and_a_later_session_and_can_be_forgotten(
    file: Path, told: str, question: str, answer: str
) -> None:
    with agent(file) as sim:
        sim.say("my name is ada")
        sim.say(told)
        assert answer in answers(sim, question)
    with agent(file) as sim:
        sim.say("my name is ada")
        assert answer in answers(sim, question)
        [(topic, _)] = dict(sim.read(persqa.facts)).items()
        what = "my " + topic if topic not in ("birthplace", "childhood", "age", "liking") else told
        assert meant(answers(sim, f"please forget {what}"), "strike")
        assert dict(sim.read(persqa.facts)) == {}
        assert sim.failures == []
    assert everything(file) == {"Ada"}
    with agent(file) as sim:
        sim.say("my name is ada")
        assert answer not in answers(sim, question)


def everything(file: Path) -> set[Any]:
    """Return the names of all nodes in memory while no agent runs."""
    memory = open_memory(ontology.Settings(path=file))
    try:
        return {node["name"] for node in memory.find("Thing").result(20)}
    finally:
        memory.close().result(20)


def test_facts_of_different_kinds_are_kept_side_by_side(file: Path, look: Look) -> None:
    with agent(file) as sim:
        sim.say("my name is nia")
        for text in (
            "I was born in Dundee",
            "I grew up in Fife",
            "I come from Scotland",
            "I like sailing",
            "I like pizza",
            "my favourite food is pizza",
            "my favourite meal is pizza",
            "my sister is called Kim",
            "my brother is called Kim",
        ):
            assert meant(answers(sim, text), "learned") or text in (
                "I come from Scotland",
                "I like sailing",
            ), sim.said[-1]
        assert "you were born in Dundee" in answers(sim, "where was I born?")
        said = answers(sim, "where do I come from?")
        assert "you come from Scotland, you were born in Dundee and you grew up in Fife" in said
        assert "you like sailing and you like pizza" in (said := answers(sim, "what do I like?")), said
        facts = dict(sim.read(persqa.facts))
    with agent(file) as sim:
        sim.say("my name is nia")
        assert dict(sim.read(persqa.facts)) == facts
    assert look()["Nia"]["sibling_of"] == ["Kim", "Kim"]


def test_a_hobby_is_confirmed_by_its_noun_alone(file: Path) -> None:
    with agent(file) as sim:
        sim.say("I play chess on Sundays")
        assert dict(sim.read(persqa.facts)) == {"hobby": ("playing chess",)}
        assert meant(answers(sim, "do I like chess?"), "confirm")
        assert meant(answers(sim, "do I like football?"), "deny")


def test_what_others_say_about_the_user_is_no_fact(file: Path) -> None:
    with agent(file) as sim:
        sim.say("people say I am from Spain")
        sim.say("Facebook says I'm 52")
        assert dict(sim.read(persqa.facts)) == {}


def test_a_clear_value_stays_beside_a_doubtful_one_of_the_same_topic(file: Path) -> None:
    with agent(file) as sim:
        sim.say("I grew up in Cairo and studied physics in Delft")
        assert sim.read(persqa.facts)["childhood"] == ("Cairo",)


def test_a_birthplace_is_an_answer_to_where_are_you_from(file: Path) -> None:
    with agent(file, topics=["origin"]) as sim:
        assert asked(sim) == "origin"
        sim.say("I was born in Dundee")
        assert answers(sim, "trains") == "I see."  # the agent no longer waits for an answer
        before = len(sim.said)
        sim.advance(100.0)
        assert len(sim.said) == before
        assert "you were born in Dundee" in answers(sim, "where am I from?")


def test_a_wrong_relative_is_corrected_and_then_removed(file: Path, look: Look) -> None:
    with agent(file) as sim:
        sim.say("my name is ada")
        sim.say("my sister is called Emma")
        assert meant(answers(sim, "no, Kim"), "corrected")
        assert meant(answers(sim, "I don't have a sister"), "struck")
        assert meant(answers(sim, "who is my sister?"), "recall_none")
    assert look() == {"Ada": {}}


def test_a_denied_occupation_is_removed(file: Path, look: Look) -> None:
    with agent(file) as sim:
        sim.say("my name is ada")
        sim.say("I work as a teacher")
        assert meant(answers(sim, "I'm not a teacher"), "struck")
        assert answers(sim, "I'm not a morning person") == "I see."
        assert meant(answers(sim, "I don't have any hobbies"), "none")
    assert look() == {"Ada": {}}


@pytest.mark.parametrize("question", ["who is my sister?", "what is my favourite food?", "how old am I?"])
def test_the_agent_asks_the_user_for_a_fact_that_it_cannot_recall(file: Path, question: str) -> None:
    with agent(file, knower()) as sim:
        assert meant(answers(sim, question), "recall_unknown")
        assert meant(answers(sim, "36" if "old" in question else "Emma"), "learned")
        assert (
            sim.said[-1].rstrip(".").endswith(("36 years old", "Emma"))
            or "Emma" in sim.said[-1]
            or "36" in sim.said[-1]
        )


@pytest.mark.parametrize(
    "question",
    [
        "how old is my sister?",
        "do I speak French?",
    ],
)
def test_facts_that_the_agent_cannot_know_are_not_made_up(file: Path, question: str) -> None:
    with agent(file, knower()) as sim:
        assert meant(answers(sim, question), "recall_not")


@pytest.mark.parametrize(
    "question",
    [
        "what should I do?",
        "I wonder what time it is",
    ],
)
def test_a_request_for_advice_is_left_to_other_modules(file: Path, question: str) -> None:
    with agent(file, knower()) as sim:
        assert answers(sim, question) == "I know it."


def test_a_question_after_a_greeting_is_answered(file: Path) -> None:
    with agent(file, knower()) as sim:
        assert meant(answers(sim, "hello, do you remember me?"), "recall_stranger")
        assert meant(answers(sim, "ada"), "learned_name")


@pytest.mark.parametrize("what", ["my sister", "my shoe size", "what I said yesterday"])
def test_unknown_facts_cannot_be_forgotten(file: Path, what: str) -> None:
    with agent(file) as sim:
        sim.say("my name is ada")
        assert meant(answers(sim, f"forget {what}"), "strike_unknown")
        assert answers(sim, "forget it") == "I see."


@pytest.mark.parametrize("text", ["forget where I live", "I don't live there any more", "I live in Bremen"])
def test_the_user_is_not_reminded_of_a_fact_that_no_longer_holds(file: Path, text: str) -> None:
    with agent(file) as sim:
        sim.say("my name is ada and i live in ulm")
    with agent(file, topics=[]) as sim:
        sim.put(interloc.users, {"console": "Ada"})
        sim.say(text)
        before = len(sim.said)
        sim.advance(60.0)
        assert len(sim.said) == before and sim.failures == []


def test_replaced_facts_and_forgotten_people_leave_no_node_in_memory(file: Path) -> None:
    with agent(file) as sim:
        for text in ("I'm called Nia", "I live in Dundee", "no, in Fife", "forget me", "yes"):
            sim.say(text)
    assert everything(file) == set()


def test_a_node_to_which_another_person_is_related_stays_in_memory(file: Path) -> None:
    with agent(file) as sim:
        for text in ("I'm called Bob", "I live in Dundee"):
            sim.say(text)
    with agent(file) as sim:
        for text in ("I'm called Nia", "I live in Dundee", "I moved to Fife"):
            sim.say(text)
    assert everything(file) == {"Bob", "Nia", "Dundee", "Fife"}


@pytest.mark.parametrize("told", ["I have two brothers", "i've got a little brother"])
def test_the_agent_asks_for_the_name_of_a_relative(file: Path, look: Look, told: str) -> None:
    with agent(file) as sim:
        sim.say("my name is ada")
        assert meant(answers(sim, told), "ask_relative")
        assert meant(answers(sim, "they are called Max and Tom"), "learned")
        assert answers(sim, told) == "I see."  # the agent knows the brothers
    assert look()["Ada"] == {"sibling_of": ["Max", "Tom"]}


def test_after_the_user_quits_their_job_the_agent_says_that_they_have_no_job(file: Path) -> None:
    with agent(file) as sim:
        sim.say("I work as a waiter")
        sim.say("I quit my job")
        assert "no job" in answers(sim, "what is my job?").lower()
