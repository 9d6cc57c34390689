"""What is understood of sentences, without a linguistic pipeline: sentences.py has them."""

import pytest

from modules.skill.persqa.sentences import (
    ANSWERED,
    CORRECTED,
    FORGET,
    GONE,
    HAS_NONE,
    INQUIRIES,
    NO_FORGET,
    NO_INQUIRIES,
    NOT_ANSWERED,
    NOT_REFUSED,
    NOT_STATED,
    REFUSED,
    STATED,
    UNCORRECTED,
)
from ravestate.modules.skill.persqa.answers import answer, correction, has_none, refuses
from ravestate.modules.skill.persqa.forgetting import wants_to_be_forgotten
from ravestate.modules.skill.persqa.inquiries import inquiry
from ravestate.modules.skill.persqa.phrase import plain
from ravestate.modules.skill.persqa.statements import statements
from ravestate.modules.skill.persqa.topics import Fact


def as_told(facts: list[Fact]) -> dict[str, tuple[str, ...]]:
    return {fact.topic: fact.values for fact in facts if not fact.gone}


@pytest.mark.parametrize(("text", "told"), STATED, ids=[text for text, _ in STATED])
def test_statements(text: str, told: dict[str, tuple[str, ...]]) -> None:
    assert as_told(statements(plain(text))) == told


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("i'm ada and i'm a baker", {"name": ("Ada",), "occupation": ("baker",)}),
        ("my name is ada and i am a baker from ulm", {"name": ("Ada",), "occupation": ("baker",)}),
        ("i work at siemens as an engineer", {"employer": ("Siemens",), "occupation": ("engineer",)}),
        ("my friends are tom and ada", {"friend": ("Tom", "Ada")}),
        ("my friends are nice and funny", {}),
    ],
)
def test_all_that_one_sentence_states(text: str, told: dict[str, tuple[str, ...]]) -> None:
    assert as_told(statements(plain(text), persons=["Ada"])) == told


@pytest.mark.parametrize("text", NOT_STATED)
def test_no_statements(text: str) -> None:
    assert as_told(statements(plain(text))) == {}


@pytest.mark.parametrize(("topic", "text", "told"), ANSWERED, ids=[f"{t}: {s}" for t, s, _ in ANSWERED])
def test_answers(topic: str, text: str, told: dict[str, tuple[str, ...]]) -> None:
    text = plain(text)
    assert as_told(statements(text, asked=topic) or answer(text, topic)) == told


@pytest.mark.parametrize(("topic", "text"), NOT_ANSWERED)
def test_no_answers(topic: str, text: str) -> None:
    text = plain(text)
    assert as_told(statements(text, asked=topic) or answer(text, topic)) == {}


@pytest.mark.parametrize(("text", "topic", "values"), GONE)
def test_what_is_no_longer_so(text: str, topic: str, values: tuple[str, ...]) -> None:
    assert statements(plain(text)) == [Fact(topic, values, gone=True)]


@pytest.mark.parametrize(("text", "topic", "known", "right"), CORRECTED)
def test_corrections(text: str, topic: str, known: str, right: str) -> None:
    assert correction(plain(text), topic, [known]) == [Fact(topic, (right,))]


@pytest.mark.parametrize(("text", "topic", "known"), UNCORRECTED)
def test_no_corrections(text: str, topic: str, known: str) -> None:
    assert correction(plain(text), topic, [known]) == []


@pytest.mark.parametrize("text", REFUSED)
def test_refusals(text: str) -> None:
    assert refuses(plain(text))


@pytest.mark.parametrize("text", NOT_REFUSED)
def test_no_refusals(text: str) -> None:
    assert not refuses(plain(text))


@pytest.mark.parametrize("text", HAS_NONE)
def test_there_is_none(text: str) -> None:
    assert has_none(plain(text))


@pytest.mark.parametrize(("text", "topic", "values"), INQUIRIES)
def test_questions_about_oneself(text: str, topic: str, values: tuple[str, ...]) -> None:
    assert inquiry(plain(text)) == Fact(topic, values)


@pytest.mark.parametrize("text", NO_INQUIRIES)
def test_questions_about_something_else(text: str) -> None:
    assert inquiry(plain(text)) is None


@pytest.mark.parametrize("text", FORGET)
def test_who_wants_to_be_forgotten(text: str) -> None:
    assert wants_to_be_forgotten(plain(text))


@pytest.mark.parametrize("text", NO_FORGET)
def test_who_does_not_want_to_be_forgotten(text: str) -> None:
    assert not wants_to_be_forgotten(plain(text))


@pytest.mark.parametrize(
    "text", ["x" * 100_000, "a, " * 30_000, "i live in " * 10_000, "no " * 30_000, "my name is " * 9_000]
)
def test_long_texts_are_read_in_no_time(text: str) -> None:
    text = plain(text)
    assert len(text) <= 500
    for topic in ("name", "home", "hobby", "friend", "club"):
        statements(text, asked=topic)
        answer(text, topic)
        correction(text, topic, ["x"])
    assert inquiry(text) is None
    assert not refuses(text)
