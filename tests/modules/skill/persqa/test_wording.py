"""The spelling of values, and the clauses that tell them."""

import pytest

from ravestate.modules.skill.persqa.topics import TOPICS
from ravestate.modules.skill.persqa.wording import clause, same, spoken, tidy


@pytest.mark.parametrize(
    ("topic", "text", "written"),
    [
        ("home", "hannover", "Hannover"),
        ("home", "new york", "New York"),
        ("home", "USA", "USA"),
        ("home", "frankfurt am main", "Frankfurt am Main"),
        ("name", "McKay", "McKay"),
        ("name", "o'brien", "O'Brien"),
        ("name", "ludwig van beethoven", "Ludwig van Beethoven"),
        ("name", "李小龍", "李小龍"),
        ("employer", "bmw", "BMW"),
        ("employer", "eBay", "eBay"),
        ("occupation", "Software Engineer", "software engineer"),
    ],
)
def test_values_get_the_right_capitals(topic: str, text: str, written: str) -> None:
    assert tidy(text, TOPICS[topic]) == written


@pytest.mark.parametrize(
    ("topic", "values", "said"),
    [
        ("home", ["Hannover"], "you live in Hannover"),
        ("hobby", ["chess", "football", "go"], "you like chess, football and go"),
        ("occupation", ["baker"], "you are a baker"),
        ("occupation", ["engineer"], "you are an engineer"),
        ("occupation", ["university teacher"], "you are a university teacher"),
        ("occupation", ["retired"], "you are retired"),
        ("friend", ["Tom", "Anna"], "you are a friend of Tom and Anna"),
    ],
)
def test_facts_are_worded_as_clauses(topic: str, values: list[str], said: str) -> None:
    assert clause(topic, values) == said


def test_every_topic_has_a_clause() -> None:
    for topic in TOPICS:
        assert spoken(topic, ["x"]) in clause(topic, ["x"])


def test_values_are_equal_regardless_of_case_and_article() -> None:
    assert same("the Red Cross", "red cross")
    assert same("Chess", "chess")
    assert not same("Ulm", "Bremen")
    assert same("the", "The")
