"""Facts outside of whole sentences: fragments about the user, and words for the people of a country."""

from __future__ import annotations

import pytest

from ravestate.modules.meta.nlp.analysis import analyse
from ravestate.modules.meta.nlp.pipeline import pipeline
from ravestate.modules.skill.persqa.reading import Reader
from ravestate.modules.skill.persqa.talk import Talk
from ravestate.modules.skill.persqa.topics import NATIONS
from ravestate.modules.skill.persqa.understanding import understand

pytestmark = pytest.mark.usefixtures("reader")

TOWNS = ("Tallinn", "Lisbon", "Kyoto")


def facts(text: str) -> dict[str, tuple[str, ...]]:
    """Return the facts that a text states, by topic."""
    return {fact.topic: fact.values for fact in Reader(analyse(text, pipeline(""))).facts() if not fact.gone}


def test_a_word_for_the_people_of_a_country_gives_the_origin() -> None:
    """At least nine in ten words do, in the form of a user who writes without capitals."""
    found = {word: facts(f"i am {word}").get("origin") for word in NATIONS}
    wrong = {word: values for word, values in found.items() if values is not None and values != (NATIONS[word],)}
    assert not wrong
    assert sum(values is not None for values in found.values()) >= 0.9 * len(NATIONS)


def test_each_part_of_a_list_of_places_keeps_its_own_topic() -> None:
    """In at least five of six lists."""
    pairs = [(born, home) for born in TOWNS for home in ("Oslo", "Milan")]
    found = [facts(f"born in {born}, now in {home}") for born, home in pairs]
    right = [one == {"birthplace": (born,), "home": (home,)} for one, (born, home) in zip(found, pairs, strict=True)]
    assert sum(right) >= 5 / 6 * len(pairs), found


@pytest.mark.parametrize(
    "text", ["now in earnest", "from time to time, now in theory", "44, 45 and 46", "now in, from, been in"]
)
def test_a_list_of_words_that_are_no_places_gives_no_place(text: str) -> None:
    assert not {"home", "origin", "birthplace", "age"} & facts(text).keys()


@pytest.mark.parametrize("text", ["just made coffee", "finally finished the report", "just missed the bus"])
def test_a_report_is_not_taken_for_the_name_that_the_agent_asked_for(text: str) -> None:
    seen = analyse(text, pipeline(""))
    meaning = understand(seen, Talk().asking("name", 0.0).speaking(), {}, 1.0, 90.0)
    assert not [fact for fact in meaning.facts if fact.topic == "name"]


@pytest.mark.parametrize("name", ["Zosia", "Kevin", "Concetta"])
@pytest.mark.parametrize(
    "frame",
    ["I go now, {} waits for me by the tram", "I named it {}", "only me now, and {}", "the neighbour brought me {}"],
)
def test_the_name_of_somebody_else_is_not_the_users_name(frame: str, name: str) -> None:
    assert "name" not in facts(frame.format(name))


@pytest.mark.parametrize("frame", ["{} speaking", "people call me {}", "you can call me {}", "I'm called {}"])
def test_an_introduction_in_other_words_gives_the_users_name(frame: str) -> None:
    assert facts(frame.format("Zosia"))["name"] == ("Zosia",)


@pytest.mark.parametrize("topic", ["name", "home", "hobby"])
@pytest.mark.parametrize("text", ["asdkjh asd", "asdkjh", "asdfgh jkl", "xkcdbwq"])
def test_nonsense_is_no_answer_to_the_agents_question(text: str, topic: str) -> None:
    reader = Reader(analyse(text, pipeline("")), topic)
    assert reader.facts() == []
    assert reader.values_in(text, topic) == []


@pytest.mark.parametrize(
    ("text", "topic"),
    [("Werner", "name"), ("Jasdeep", "name"), ("Þórdís", "name"), ("Antwerp", "home"), ("Afghanistan", "origin")],
)
def test_a_rare_name_is_an_answer_to_the_agents_question(text: str, topic: str) -> None:
    reader = Reader(analyse(text, pipeline("")), topic)
    assert {fact.topic: fact.values for fact in reader.facts()} == {topic: (text,)}
