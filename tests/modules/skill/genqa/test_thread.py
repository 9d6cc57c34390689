"""The thread of a conversation completes follow-up questions. The quality sets ``readings_rows`` and ``thread_rows`` measure how well."""

import pytest

from ravestate.modules.skill.genqa.answering import Answer
from ravestate.modules.skill.genqa.question import parse
from ravestate.modules.skill.genqa.thread import LONGEST, Turn, overheard, readings, turn_of

KESH = ("How high is Mount Kesh?", "Mount Kesh is 4,210 metres high.", "Mount Kesh")
OLIN = ("How high is Mount Olin?", "Mount Olin is 3,870 metres high.", "Mount Olin")
HUSBAND = ("Who was the husband of Clara Venn?", "The husband of Clara Venn was the painter Hugo Aster.", "Clara Venn")
BRIDGES = ("What are the bridges of Tarm?", "The bridges of Tarm are the Mill Bridge and the Salt Bridge.", "Tarm")


def talk(*said: tuple[str, str, str]) -> list[Turn]:
    return [turn_of(parse(question), Answer(question, text, "s", title), 0.0) for question, text, title in said]


@pytest.mark.parametrize("name", ["Mount Kesh", "Tarm", "The Marlow"])
def test_a_pronoun_or_a_fragment_is_completed_by_the_last_question(name: str) -> None:
    thread = talk((f"Where is {name}?", f"{name} is in Norland.", name))
    for follow, meant in (
        ("who found it?", f"who found {name}?"),
        ("and its capital?", f"{name}'s capital?"),
        ("and Lissel?", "Where is Lissel?"),
        ("no, I meant Lissel", "Where is Lissel?"),
    ):
        assert meant in [reading.text for reading in readings(parse(follow), thread)]


def test_the_former_and_the_second_one_choose_among_several_things() -> None:
    for said, follow, meant in (
        ([KESH, OLIN], "who climbed the former first?", "who climbed Mount Kesh first?"),
        ([BRIDGES], "when was the second one built?", "when was the Salt Bridge built?"),
    ):
        assert meant in [reading.text for reading in readings(parse(follow), talk(*said))]


@pytest.mark.parametrize("follow", ["when was he born?", "who was his wife?"])
def test_the_first_reading_of_a_pronoun_is_the_person_in_the_last_answer(follow: str) -> None:
    assert "Hugo Aster" in readings(parse(follow), talk(HUSBAND))[0].text


@pytest.mark.parametrize("heard", ["And its capital?", "which one is bigger?", "and when?", "how high is it?"])
def test_without_a_thread_a_question_with_a_reference_has_no_readings(heard: str) -> None:
    assert readings(parse(heard), ()) == []


@pytest.mark.parametrize(
    "heard", ["What is the capital of France?", "When did it start to rain?", "how do plants make their food?"]
)
def test_a_complete_question_is_not_changed(heard: str) -> None:
    assert readings(parse(heard), ())[0].text == heard


@pytest.mark.parametrize("heard", ["", "?", "there " * LONGEST])
def test_every_text_has_a_limited_number_of_readings(heard: str) -> None:
    assert len(readings(parse(heard), talk(KESH))) <= 20


def test_the_first_reading_of_a_question_without_a_name_is_about_the_current_subject() -> None:
    first, *_ = readings(
        parse("who was on board?"), talk(("When did the Marlow sink?", "The Marlow sank.", "The Marlow"))
    )
    assert first.about == "The Marlow"


def test_a_name_is_recognised_in_lower_case_if_a_document_is_about_it() -> None:
    turns = talk(("who was the captain of the marlow", "Her captain was Jonas Hale.", "The Marlow"))
    titles = {"the ostara": "The Ostara"}
    first, *_ = readings(parse("and the ostara?"), turns, lambda name: titles.get(name.lower(), ""))
    assert first.text == "who was the captain of the ostara?"


def test_a_question_can_refer_to_a_name_in_the_agents_words() -> None:
    said = overheard("I live in Hannover.", 0.0)
    assert "how many people live in Hannover?" in [
        r.text for r in readings(parse("how many people live there?"), [said])
    ]


def test_a_fragment_can_be_completed_from_an_older_question() -> None:
    capital = ("What is the capital of Peru?", "The capital of Peru is Lima.", "Peru")
    found = readings(parse("and of Chile?"), talk(capital, HUSBAND, KESH))
    assert "What is the capital of Chile?" in [reading.text for reading in found]


@pytest.mark.parametrize("follow", ["who was he?", "where is it?", "when was that?"])
def test_a_question_of_a_question_word_and_a_pronoun_has_readings(follow: str) -> None:
    assert readings(parse(follow), talk(HUSBAND))


def test_a_pronoun_refers_to_the_thing_in_the_question_before() -> None:
    turns = talk(("What is Okapia?", "Okapia is a board game.", "Okapia"))
    assert [reading.about for reading in readings(parse("who invented it?"), turns)] == ["Okapia"]


def test_a_pronoun_refers_to_the_animal_in_the_question_before() -> None:
    turns = talk(("who is bertha", "Bertha is a giant tortoise in Willowbrook Zoo.", "Bertha"))
    assert readings(parse("when did she come to the zoo?"), turns)[0].text == "when did Bertha come to the zoo?"
