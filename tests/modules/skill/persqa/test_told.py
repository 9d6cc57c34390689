"""Free statements are remembered, used as answers, and forgotten. The quality set ``recalled_rows`` has more questions."""

from __future__ import annotations

from pathlib import Path

import pytest

from modules.skill.persqa.conftest import Look
from modules.skill.persqa.test_scenarios import agent, answers, knower, meant
from ravestate.modules import ontology, persqa
from ravestate.modules.meta.nlp.analysis import analyse
from ravestate.modules.meta.nlp.pipeline import pipeline
from ravestate.modules.meta.ontology import worker
from ravestate.modules.skill.persqa.reading import Reader
from ravestate.modules.skill.persqa.told import Told, recalled, told_in

pytestmark = pytest.mark.usefixtures("reader")

TOLD = [
    ("Jonas plays the violin", "what does Jonas play?", "Jonas plays the violin"),
    ("I painted a dragon", "what did I paint?", "you painted a dragon"),
    ("my sister Rosa lives in Antwerp", "where does my sister live?", "your sister Rosa lives in Antwerp"),
    ("my mother works at a school", "where does my mother work?", "your mother works at a school"),
]
ASKED = [
    (["I hate fish"], "do I like fish?", "you hate fish"),
    (["my flatmate Jon is allergic to nuts"], "is Jon allergic to nuts?", "your flatmate Jon is allergic to nuts"),
    (["I play chess on Sundays"], "when do I play chess?", "you play chess on Sundays"),
    (["Ines lives in Rome", "Ines moved to Vienna"], "where does Ines live?", "Ines moved to Vienna"),
    (
        ["I live with my mother in Porto", "my mother lives in Braga actually"],
        "where does my mother live?",
        "your mother lives in Braga actually",
    ),
    (["my mother is called Teresa", "her sister is Lucia"], "who is Lucia?", "Teresa's sister is Lucia"),
    (["my mother is kind", "her sister is Lucia"], "who is Lucia?", "your mother's sister is Lucia"),
]
NOT_TOLD = [
    (["my flatmate Jon is allergic to nuts"], "am I allergic to nuts?"),
    (["my dog is called Bello"], "how is your dog?"),
    (["I wear glasses"], "what do I wear?"),
]


@pytest.mark.parametrize("frame", ["{} lol", "{}, haha!", "{} hahaha lol", "lol {}", "{} tbh", "tbh {}"])
@pytest.mark.parametrize(
    ("statement", "text", "object"),
    [
        ("i painted a dragon", "you painted a dragon", "dragon"),
        ("my sister Rosa plays the violin", "your sister Rosa plays the violin", "violin"),
        ("Jonas lives in Ghent", "Jonas lives in Ghent", "Ghent"),
    ],
)
def test_a_free_statement_is_kept_without_laughter_and_other_asides(
    frame: str, statement: str, text: str, object: str
) -> None:
    [one], _ = told_in(Reader(analyse(frame.format(statement), pipeline(""))))
    assert (one.text, one.object) == (text, object)


@pytest.mark.parametrize(("told", "question", "answer"), TOLD, ids=[told for told, _, _ in TOLD])
def test_a_free_statement_answers_a_question_in_this_and_a_later_session(
    file: Path, told: str, question: str, answer: str
) -> None:
    with agent(file, knower()) as sim:
        assert answer not in answers(sim, question)
        sim.say("my name is ada")
        sim.say(told)
        assert answer in answers(sim, question)
    with agent(file, knower()) as sim:
        sim.say("my name is ada")
        assert answer in answers(sim, question)
        assert sim.failures == []


def test_a_free_statement_is_kept_with_its_speaker_and_its_time(file: Path) -> None:
    with agent(file) as sim:
        sim.say("my name is ada")
        assert answers(sim, "Jonas plays the violin") == "I see."  # small talk answers
        [one] = dict(sim.read(persqa.told)).values()
        assert (one.subject, one.verb, one.object, one.by) == ("Jonas", "play", "violin", "Ada")
        memory = sim.read(ontology.memory)
        assert memory is not None and one.at is not None
        [remark] = memory.find("Remark").result(20)
        assert remark["wording"] == "Jonas plays the violin" and remark["said_at"] == one.at


def test_a_statement_that_comes_before_the_users_name_is_recalled_and_saved(file: Path, look: Look) -> None:
    with agent(file) as sim:
        sim.say("I painted a dragon")
        assert "you painted a dragon" in answers(sim, "what did I paint?")
        sim.say("my name is ada")
    assert look() == {"Ada": {"has_told": ["you painted a dragon"]}}


def test_a_question_that_nothing_answers_is_left_to_others(file: Path) -> None:
    with agent(file, knower()) as sim:
        sim.say("my presentation is on Thursday")
        assert answers(sim, "can I ask you something?") == "I know it."
        assert "Thursday" not in answers(sim, "when does my train leave?")
        sim.say("I like the capital of Peru")
        assert answers(sim, "what is the capital of Peru?") == "I know it."


@pytest.mark.parametrize("text", ["forget Jonas", "forget that Jonas plays the violin"])
def test_a_free_statement_can_be_forgotten(file: Path, look: Look, text: str) -> None:
    with agent(file) as sim:
        sim.say("my name is ada")
        sim.say("Jonas plays the violin")
        assert meant(answers(sim, text), "strike")
        assert dict(sim.read(persqa.told)) == {}
    assert look() == {"Ada": {}}


@pytest.mark.parametrize(
    ("told", "wish", "question"),
    [
        ("I live in Dundee", "forget where I live", "where do I live?"),
        ("Jonas plays the violin", "forget Jonas", "what does Jonas play, do you remember?"),
    ],
)
def test_forgotten_words_are_not_found_in_the_conversation(file: Path, told: str, wish: str, question: str) -> None:
    with agent(file, knower()) as sim:
        sim.say("my name is ada")
        sim.say(told)
        sim.say(wish)
        assert not {"Dundee", "violin"} & set(answers(sim, question).strip(".").split())


def holds(file: Path, words: bytes) -> bool:
    """Return whether any file of the memory has these bytes."""
    return any(words in one.read_bytes() for one in file.parent.iterdir())


def test_the_agent_confirms_forgetting_only_when_the_file_has_no_byte_of_it(
    file: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(worker, "PAUSE", 3600.0)
    with agent(file) as sim:
        sim.say("my name is ada")
        sim.say("I live in Dundee")
        assert holds(file, b"Dundee")
        assert meant(answers(sim, "forget where I live"), "strike")
        assert not holds(file, b"Dundee")


def test_a_correction_is_answered_before_the_old_value_leaves_the_file(
    file: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(worker, "PAUSE", 3600.0)
    with agent(file) as sim:
        sim.say("my name is ada")
        sim.say("I live in Dundee")
        assert answers(sim, "I live in Leeds")
        assert holds(file, b"Dundee")
    assert not holds(file, b"Dundee")
    assert holds(file, b"Leeds")


def test_forgetting_a_relative_removes_the_statements_about_them(file: Path, look: Look) -> None:
    with agent(file) as sim:
        sim.say("my name is ada")
        sim.say("my sister is called Emma")
        sim.say("Emma plays the violin")
        assert meant(answers(sim, "forget my sister"), "strike")
    assert look() == {"Ada": {}}


@pytest.mark.parametrize("frame", ["{} wants to play", "does {} play?", "Tom says that {} plays", "{} doesn't play"])
def test_wishes_questions_hearsay_and_denials_are_not_kept(frame: str) -> None:
    for who in ("Jonas", "my sister", "I"):
        assert told_in(Reader(analyse(f"{frame.format(who)} the violin", pipeline(""))))[0] == []


@pytest.mark.parametrize("relative", ["neighbour", "boss"])
def test_a_question_for_a_person_is_answered_with_their_name(relative: str) -> None:
    said: list[Told] = []
    for text in (f"my {relative} is ill", f"my {relative} Karl plays the drums", f"my {relative} has a cat"):
        said += told_in(Reader(analyse(text, pipeline(""))), said)[1]
    found = recalled(Reader(analyse(f"Who is my {relative}?", pipeline(""))), said, {})
    assert [one.text for one in found] == [f"your {relative} Karl plays the drums"]


@pytest.mark.parametrize(("told", "question", "answer"), ASKED, ids=[question for _, question, _ in ASKED])
def test_the_latest_statement_about_the_subject_of_a_question_answers_it(
    told: list[str], question: str, answer: str
) -> None:
    assert [one.text for one in remembered(told, question)] == [answer]


@pytest.mark.parametrize(("told", "question"), NOT_TOLD, ids=[question for _, question in NOT_TOLD])
def test_a_statement_about_another_subject_answers_no_question(told: list[str], question: str) -> None:
    assert remembered(told, question) == []


def remembered(told: list[str], question: str) -> list[Told]:
    said: list[Told] = []
    for one in told:
        said += told_in(Reader(analyse(one, pipeline(""))), said)[1]
    return recalled(Reader(analyse(question, pipeline(""))), said, {})


def test_a_question_about_a_relative_who_was_not_mentioned_is_not_answered_with_everything(file: Path) -> None:
    with agent(file) as sim:
        sim.say("I have a brother called Max")
        assert meant(answers(sim, "did I tell you about my sister?"), "recall_unknown")
        assert meant(answers(sim, "did I tell you about my aunt?"), "recall_not")
        assert "Max" in answers(sim, "did I tell you about my brother?")


def test_a_sister_in_law_is_no_sister_and_can_be_forgotten_in_a_later_session(file: Path, look: Look) -> None:
    with agent(file) as sim:
        sim.say("I'm Anna")
        sim.say("my sister-in-law Petra lives in Lyon")
        assert dict(sim.read(persqa.facts)) == {}
    with agent(file) as sim:
        sim.say("I'm Anna")
        assert meant(answers(sim, "forget my sister-in-law"), "strike")
    assert look() == {"Anna": {}}
