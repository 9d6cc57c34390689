"""Identity: a user gives a name that memory knows, or corrects whom the agent takes them for."""

from __future__ import annotations

from pathlib import Path

import pytest

from modules.skill.persqa.conftest import Look
from modules.skill.persqa.test_scenarios import agent, answers, meant
from ravestate.modules import hibye, interloc, persqa
from ravestate.testing import Simulation

pytestmark = pytest.mark.usefixtures("reader")


@pytest.fixture
def ada(file: Path) -> Path:
    """Return the file of a memory that knows Ada, who lives in Hannover and has a sister."""
    with agent(file) as sim:
        sim.say("my name is ada and i live in hannover")
        sim.say("my sister is called Emma")
    return file


def name_of(sim: Simulation) -> str | None:
    who = sim.read(persqa.who)
    return None if who is None else who["name"]


def test_a_user_who_says_a_known_name_is_asked_a_question_that_reveals_nothing(ada: Path) -> None:
    with agent(ada, confirm=True) as sim:
        said = answers(sim, "i'm ada")
        assert meant(said, "vouch_home") and "Hannover" not in said
        assert dict(sim.read(persqa.facts)) == {}
        assert meant(answers(sim, "in hannover"), "welcome_back")
        assert sim.read(persqa.facts)["sister"] == ("Emma",)


@pytest.mark.parametrize("text", ["bremen", "i don't know", "none of your business", "no"])
def test_after_a_wrong_or_refused_answer_the_user_is_a_new_person_with_the_same_name(
    ada: Path, look: Look, text: str
) -> None:
    with agent(ada, confirm=True) as sim:
        sim.say("my name is ada")
        assert meant(answers(sim, text), "namesake")
        assert dict(sim.read(persqa.facts)) == {}
        sim.say("i work as a baker")
        said = answers(sim, "what do you know about me?")
        assert "baker" in said and "Hannover" not in said and "Emma" not in said
    with agent(ada) as sim:
        sim.say("i'm called ada")
        assert "you live in Hannover" in answers(sim, "where do i live?")


@pytest.mark.parametrize("first", ["hi, i'm kim", "hi kim here", "kim here"])
@pytest.mark.parametrize("confirm", [True, False])
def test_a_person_is_recognised_even_if_memory_knows_only_their_name(file: Path, first: str, confirm: bool) -> None:
    with agent(file, confirm=confirm) as sim:
        assert meant(answers(sim, first), "learned_name")
    with agent(file, confirm=confirm) as sim:
        assert meant(answers(sim, "hi, kim here"), "back")


def test_the_agent_reveals_no_fact_before_the_user_has_answered(ada: Path) -> None:
    with agent(ada, confirm=True) as sim:
        sim.say("my name is ada")
        for text in ("where do i live?", "who is my sister?", "what do you know about me?", "do i live in hannover?"):
            said = answers(sim, text)
            assert "Emma" not in said and "you live in Hannover" not in said


def test_a_user_who_also_tells_a_known_fact_is_recognised_without_a_question(ada: Path) -> None:
    with agent(ada, confirm=True) as sim:
        assert meant(answers(sim, "my name is ada and i live in hannover"), "welcome_back")


def test_the_answer_decides_which_of_two_namesakes_is_recognised(ada: Path) -> None:
    with agent(ada, confirm=True) as sim:
        sim.say("my name is ada")
        sim.say("bremen")
        sim.say("i live in bremen")
    with agent(ada, confirm=True) as sim:
        sim.say("my name is ada")
        assert meant(answers(sim, "bremen"), "welcome_back")
        assert "sister" not in sim.read(persqa.facts)


def test_a_user_whom_the_platform_recognises_is_asked_no_question(ada: Path) -> None:
    with agent(ada, confirm=True) as sim:
        sim.put(interloc.users, {"camera": "Ada"})
        assert "you live in Hannover" in answers(sim, "where do i live?")


@pytest.mark.parametrize("text", ["it's me, Marlene", "this is Marlene again", "hello, it is me, marlene"])
def test_users_can_say_who_they_are(file: Path, text: str) -> None:
    with agent(file, hibye) as sim:
        sim.say(text)
        assert name_of(sim) == "Marlene"


@pytest.mark.parametrize("text", ["guess who", "I'm back"])
def test_an_unknown_user_who_says_that_they_are_back_is_asked_for_their_name(file: Path, text: str) -> None:
    with agent(file) as sim:
        assert meant(answers(sim, text), "identify")
        assert meant(answers(sim, "marlene"), "learned_name")
        assert meant(answers(sim, text), "back")


def test_a_user_can_say_that_the_agent_has_mistaken_them_for_another_person(ada: Path, look: Look) -> None:
    with agent(ada) as sim:
        sim.say("i'm called ada")
        sim.say("i work as a baker")
        assert meant(answers(sim, "no, I'm her sister"), "mistaken")
        assert name_of(sim) is None and "home" not in sim.read(persqa.facts)
        sim.say("emma")
        assert name_of(sim) == "Emma"
    people = look()
    assert "works_as" not in people["Ada"] and people["Emma"] == {"works_as": ["baker"]}


@pytest.mark.parametrize("text", ["I'm not Ada", "my name isn't Ada"])
def test_a_denied_name_is_asked_again_and_leaves_no_person(file: Path, look: Look, text: str) -> None:
    with agent(file) as sim:
        sim.say("my name is ada")
        assert meant(answers(sim, text), "mistaken")
        assert name_of(sim) is None
        sim.say("ida")
        assert name_of(sim) == "Ida"
    assert list(look()) == ["Ida"]


def test_the_name_is_asked_after_the_first_hello_once(file: Path) -> None:
    with agent(file, hibye) as sim:
        sim.say("hello")
        assert "hibye:answer_hello" in sim.fired and len(sim.said) == 1
        sim.advance(3.5)
        assert meant(sim.said[-1], "ask_name") and len(sim.said) == 2
        sim.say("hello")
        sim.advance(3.5)
        assert "persqa:introduce" not in sim.fired[sim.fired.index("persqa:introduce") + 1 :]


def test_a_user_who_goes_on_talking_after_hello_is_not_interrupted(file: Path) -> None:
    with agent(file, hibye) as sim:
        sim.say("hello")
        sim.advance(2.0)
        sim.say("what a nice day")
        sim.advance(2.5)
        assert "persqa:introduce" not in sim.fired


@pytest.mark.parametrize(
    "texts", [["bye", "I'm Peter"], ["goodbye", "now it's me, Peter"], ["this is Peter"], ["Peter here"]]
)
def test_another_name_after_a_farewell_or_for_who_is_here_begins_another_acquaintance(
    file: Path, look: Look, texts: list[str]
) -> None:
    with agent(file) as sim:
        sim.say("I'm Anna")
        sim.say("I live in Graz")
        for text in texts[:-1]:
            sim.say(text)
        assert meant(answers(sim, texts[-1]), "learned_name")
        assert (name_of(sim), dict(sim.read(persqa.facts))) == ("Peter", {})
    assert look() == {"Anna": {"lives_in": ["Graz"]}, "Peter": {}}


@pytest.mark.parametrize("text", ["no, I'm Peter", "no, this is Peter", "sorry, Peter here", "this is Annah"])
def test_a_corrected_name_keeps_the_facts(file: Path, text: str) -> None:
    with agent(file) as sim:
        sim.say("I'm Anna")
        sim.say("I live in Graz")
        assert meant(answers(sim, text), "renamed")
        assert dict(sim.read(persqa.facts)) == {"home": ("Graz",)}


def test_a_bare_answer_to_a_question_is_no_farewell(file: Path) -> None:
    with agent(file, hibye) as sim:
        sim.say("I'm Anna")
        assert meant(answers(sim, "where do I live?"), "recall_unknown")
        assert meant(answers(sim, "Bonn"), "learned_home")
        assert not sim.read(persqa.talk).quiet


@pytest.mark.parametrize(
    ("first", "again"),
    [
        (["the name's O'Hara, Sinéad O'Hara"], "it's Sinéad"),
        (["I'm Mo", "no, my name is Mohammed"], "it's Mo"),
        (["I'm Sam"], "my name is Samantha Reed"),
    ],
)
def test_a_person_who_returns_under_a_part_or_another_form_of_their_name_is_asked_a_question(
    file: Path, look: Look, first: list[str], again: str
) -> None:
    with agent(file, confirm=True) as sim:
        for text in (*first, "I live in Leeds"):
            sim.say(text)
        name = name_of(sim)
    with agent(file, confirm=True) as sim:
        assert meant(answers(sim, again), "vouch_home")
        assert meant(answers(sim, "in Leeds"), "welcome_back")
        assert name_of(sim) == name
    with agent(file, confirm=True) as sim:
        sim.say(again)
        assert meant(answers(sim, "in Ghent"), "namesake")
        assert dict(sim.read(persqa.facts)) == {}
        assert name_of(sim) != name


def test_a_short_form_with_a_known_fact_is_recognised(file: Path, look: Look) -> None:
    for text in ("I'm Mohammed and I live in Leeds", "I'm Mo and I live in Leeds"):
        with agent(file, confirm=True) as sim:
            sim.say(text)
    assert look() == {"Mohammed": {"lives_in": ["Leeds"]}}


def test_paul_is_not_taken_for_paula(file: Path) -> None:
    with agent(file, confirm=True) as sim:
        sim.say("I'm Paula and I live in Leeds")
    with agent(file, confirm=True) as sim:
        assert meant(answers(sim, "I'm Paul"), "learned_name")
