"""Facts are put into words, and a phrase can be said only if all its facts are known."""

from __future__ import annotations

from datetime import UTC, date, datetime

import pytest

from ravestate.modules.skill.agentqa import Topic
from ravestate.modules.skill.agentqa.life import Fact
from ravestate.modules.skill.agentqa.telling import age, listed, telling

DAY = date(2026, 3, 1)


def told(topic: Topic, question: str = "", **facts: Fact) -> tuple[str, ...] | None:
    return telling(topic, question, facts, mood="fine", now=datetime(2026, 3, 1, 9, 5, tzinfo=UTC))


@pytest.mark.parametrize(
    ("items", "text"),
    [(["a"], "a"), (["a", "b"], "a and b"), (["a", "b", "c"], "a, b and c")],
)
def test_a_list_of_values_is_joined_with_commas_and_and(items: list[str], text: str) -> None:
    assert listed(items) == text


@pytest.mark.parametrize(
    ("born", "words"),
    [
        (date(2026, 3, 1), "0 days"),
        (date(2026, 2, 28), "1 day"),
        (date(2026, 3, 5), "0 days"),  # the date of birth is in the future
        (date(2026, 1, 2), "58 days"),
        (date(2026, 1, 1), "2 months"),
        (date(2025, 3, 2), "11 months"),
        (date(2025, 3, 1), "1 year"),
        (date(2024, 3, 2), "1 year"),
        (date(2024, 2, 29), "2 years"),
        (date(1926, 3, 1), "100 years"),
    ],
)
def test_an_age_is_given_in_days_months_or_years(born: date, words: str) -> None:
    assert age(born, DAY) == words


def test_only_phrases_whose_facts_are_all_known_can_be_said() -> None:
    topic = Topic("home", (), ("I live in {home}.", "I live in {home} with {cat}."), ("Nowhere.",))
    assert told(topic, home="Rome") == ("I live in Rome.",)
    assert told(topic, home="Rome", cat=("Tom", "Ann")) == (
        "I live in Rome.",
        "I live in Rome with Tom and Ann.",
    )
    assert told(topic) == told(topic, home=()) == ("Nowhere.",)
    assert told(Topic("home", (), ("I live in {home}.",))) is None


def test_age_birthday_and_mood_can_be_used_as_facts() -> None:
    topic = Topic("age", (), ("{age} since {born}, and {mood}.",))
    assert told(topic, born="2024-02-29") == ("2 years since 29 February 2024, and fine.",)


def test_the_answer_is_about_the_value_in_the_question() -> None:
    topic = Topic(
        "likes",
        (),
        ("I like {likes}.",),
        named=(
            ("favourites", ("My {it} is {that}.",)),
            ("likes", ("Yes, {it}.",)),
            ("enemy", ("Not {it}.",)),
        ),
    )
    facts: dict[str, Fact] = {
        "likes": ("tea", "ice cream"),
        "favourites": (("colour", "blue"),),
        "enemy": "rust",
    }
    assert told(topic, "what is your favourite colour", **facts) == ("My colour is blue.",)
    assert told(topic, "do you like ice cream", **facts) == ("Yes, ice cream.",)
    assert told(topic, "do you like rust", **facts) == ("Not rust.",)
    assert told(topic, "do you like ice creams", **facts) == ("Yes, ice cream.",)
    assert told(topic, "do you like steam", **facts) is None  # not a match for "tea", so another module may answer
    assert told(topic, "what is your favourite bird", **facts) is None
    assert told(topic, "what do you like", **facts) == ("I like tea and ice cream.",)


def test_a_fact_at_the_beginning_of_a_sentence_gets_a_capital() -> None:
    topic = Topic("hobbies", (), ("{hobbies}. My hobbies? {hobbies}: {hobbies}, {hobbies}",))
    assert told(topic, hobbies="chess") == ("Chess. My hobbies? Chess: Chess, chess",)


def test_braces_in_a_fact_are_plain_text() -> None:
    assert told(Topic("x", (), ("I like {likes}.",)), likes="{curly} things") == ("I like {curly} things.",)


def test_if_the_answers_about_a_value_need_an_unknown_fact_the_topic_answers_without_them() -> None:
    named = (("hobbies", ("I do {it} with {friends}.",)),)
    hobbies: dict[str, Fact] = {"hobbies": ("chess", "darts")}
    topic = Topic("hobbies", (), ("I like {hobbies}.",), ("I have no hobby.",), named, ("No, I do not.",))
    assert told(topic, "do you like chess", **hobbies) == ("I like chess and darts.",)
    assert told(topic, "do you like chess", **hobbies, friends="Ann") == ("I do chess with Ann.",)
    assert told(topic, "do you like golf", **hobbies) == ("No, I do not.",)


def test_another_fact_that_has_the_value_may_have_the_answer() -> None:
    named = (("hobbies", ("I do {it} with {friends}.",)), ("likes", ("Yes, {it}.",)))
    topic = Topic("hobbies", (), ("I like {hobbies}.",), named=named)
    assert told(topic, "do you like chess", hobbies=("chess",), likes=("chess",)) == ("Yes, chess.",)


def test_if_no_answer_about_a_value_is_known_other_modules_may_answer() -> None:
    """The agent does not deny the value."""
    named = (("hobbies", ("I do {it} with {friends}.",)),)
    topic = Topic("hobbies", (), ("I am {mood_of_today}.",), ("I have no hobby.",), named, ("No, I do not.",))
    assert told(topic, "do you like chess", hobbies=("chess",)) is None
