"""`due` returns the topic that the agent asks about next."""

import pytest

from ravestate.modules import ontology
from ravestate.modules.meta.ontology.opening import types_of
from ravestate.modules.skill.persqa.topics import TOPICS, due, touched_by

ALL = tuple(TOPICS)


def next_topic(known: dict[str, tuple[str, ...]], **more: object) -> str:
    given = {"closed": (), "tries": {}, "limit": 2, "touched": ALL, **more}
    return due(ALL, known, **given)  # type: ignore[arg-type]


def test_the_name_comes_first_and_then_the_topics_in_table_order() -> None:
    assert next_topic({}) == "name"
    assert next_topic({"name": ("Ada",)}) == "home"
    assert next_topic({}, closed=["name"]) == "home"


def test_the_topic_with_fewer_tries_comes_first_and_none_is_tried_three_times() -> None:
    assert next_topic({}, tries={"name": 1}) == "home"
    assert next_topic({}, tries=dict.fromkeys(ALL, 1)) == "name"
    assert next_topic({}, tries=dict.fromkeys(ALL, 2)) == ""


@pytest.mark.parametrize(("last", "follow"), [("occupation", "employer"), ("subject", "university")])
def test_a_follow_up_comes_first_but_only_after_an_answer_to_its_topic(last: str, follow: str) -> None:
    assert next_topic({"name": ("Ada",), last: ("x",)}, last=last) == follow
    everything_else = {topic: ("30",) for topic in ALL if topic not in (last, follow)}
    assert next_topic(everything_else, closed=[last]) == ""
    assert next_topic({**everything_else, last: ()}) == ""


@pytest.mark.parametrize("occupation", ["student", "Retired", "self-employed"])
def test_students_pensioners_and_the_self_employed_are_not_asked_for_an_employer(occupation: str) -> None:
    known = {topic: ("30",) for topic in ALL if topic != "employer"}
    assert next_topic(known) == "employer"
    assert next_topic({**known, "occupation": (occupation,)}) == ""


@pytest.mark.parametrize(("age", "first"), [("9", ""), ("15", "home"), ("30", "occupation"), ("86", "home")])
def test_the_agent_asks_a_child_nothing_and_asks_old_people_and_teenagers_nothing_about_work(
    age: str, first: str
) -> None:
    assert due(["occupation", "subject", "home"], {"age": (age,)}, (), {}, touched=ALL, limit=2) == first


def test_the_agent_asks_about_work_and_studies_only_after_the_user_has_mentioned_them() -> None:
    assert due(["occupation", "subject"], {}, (), {}, limit=2) == ""
    touched = touched_by(["my", "boss", "be", "angry"])
    assert due(["occupation", "subject"], {}, (), {}, touched=touched, limit=2) == "occupation"


def test_memory_has_the_relation_and_type_of_each_topic() -> None:
    types = types_of(ontology.Settings())
    for topic in TOPICS.values():
        if topic.relation:
            types.check_relation("Person", topic.relation, topic.type)
