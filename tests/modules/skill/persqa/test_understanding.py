"""Laws for every utterance. The quality set ``persqa_facts`` measures how well utterances are understood."""

from dataclasses import replace

import pytest

from ravestate.modules.meta.nlp.analysis import Analysis, analyse
from ravestate.modules.meta.nlp.pipeline import pipeline
from ravestate.modules.skill.persqa.talk import CONFIRM, FORGET, Talk
from ravestate.modules.skill.persqa.topics import TOPICS
from ravestate.modules.skill.persqa.understanding import understand

pytestmark = pytest.mark.usefixtures("reader")


def seen(text: str) -> Analysis:
    return analyse(text, pipeline(""))


def talk_about(topic: str) -> Talk:
    return Talk().asking(topic, 0.0).speaking()


@pytest.mark.parametrize(
    "text", ["x" * 100_000, "a, " * 30_000, "i live in " * 10_000, "no " * 30_000, "my name is " * 9_000]
)
def test_a_long_text_is_read_only_at_its_beginning(text: str) -> None:
    analysis = seen(text)
    for topic in ("name", "home", "hobby", "friend", "club"):
        meaning = understand(analysis, talk_about(topic), {}, 1.0, 90.0)
        assert all(len(value) <= 500 for fact in meaning.facts for value in fact.values)


@pytest.mark.parametrize("text", ["", "   ", "...", "?!", "🙂", "\x00\x1b[31m"])
def test_empty_utterances_mean_nothing(text: str) -> None:
    assert understand(seen(text), talk_about("name"), {}, 1.0, 90.0).kind == "nothing"
    assert understand(seen(text), Talk(), {}, 1.0, 90.0).kind == "nothing"


def test_an_answer_counts_only_while_the_question_is_open() -> None:
    heard = seen("hannover")
    assert understand(heard, talk_about("home"), {}, 90.0, 90.0).kind == "told"
    assert understand(heard, talk_about("home"), {}, 91.0, 90.0).kind == "nothing"


def test_a_denial_of_an_unknown_fact_gets_no_reply() -> None:
    heard = seen("i don't live in hannover")
    assert not understand(heard, Talk(), {}, 1.0, 90.0).aloud
    assert understand(heard, Talk(), {"home": ("Hannover",)}, 1.0, 90.0).aloud


@pytest.mark.parametrize("topic", [name for name, topic in TOPICS.items() if topic.asked])
@pytest.mark.parametrize(
    "text", ["the train was late again", "can you swim?", "that movie was great", "my sister paints"]
)
def test_an_unrelated_sentence_is_not_taken_for_the_answer_to_a_question(topic: str, text: str) -> None:
    assert not understand(seen(text), talk_about(topic), {}, 1.0, 90.0).facts


def test_a_general_question_is_not_answered_from_the_users_statements() -> None:
    told = understand(seen("our baby has been crying for three hours"), Talk(), {}, 1.0, 90.0).said
    talk = replace(Talk(), said=told)
    assert told
    assert understand(seen("why do babies cry so much?"), talk, {}, 1.0, 90.0).kind == "nothing"


def test_only_a_yes_immediately_after_the_question_forgets_the_user() -> None:
    assert understand(seen("yes"), talk_about(FORGET), {}, 1.0, 90.0).kind == "forget_yes"
    assert understand(seen("yes"), talk_about(FORGET).speaking(), {}, 1.0, 90.0).kind == "nothing"


@pytest.mark.parametrize("text", ["don't forget me", "never forget me", "he wants to forget me", "forget it"])
def test_sentences_that_resemble_a_wish_to_be_forgotten_forget_nothing(text: str) -> None:
    assert understand(seen(text), Talk(), {"name": ("Ada",)}, 1.0, 90.0).kind not in ("forget", "strike")


@pytest.mark.parametrize(
    ("text", "values"), [("in hannover", ("Hannover",)), ("I live in Ulm", ("Ulm",)), ("I'd rather not say", ())]
)
def test_a_fact_or_a_refusal_answers_the_question_that_tests_who_the_user_is(
    text: str, values: tuple[str, ...]
) -> None:
    talk = Talk(doubt="home").asking(CONFIRM, 0.0).speaking()
    meaning = understand(seen(text), talk, {"name": ("Ada",)}, 1.0, 90.0)
    assert meaning.kind == "vouched"
    assert tuple(value for fact in meaning.facts for value in fact.values) == values


def test_a_name_before_a_question_is_learned_without_a_comment() -> None:
    meaning = understand(seen("hey! i'm thabo, how are you?"), Talk(), {}, 1.0, 90.0)
    assert [fact.values for fact in meaning.facts] == [("Thabo",)] and not meaning.aloud


def test_his_name_is_the_name_of_the_relative_mentioned_before() -> None:
    father = understand(seen("My father died nine days ago."), Talk(), {}, 1.0, 90.0)
    talk = Talk().listening(1.0, leave=False, person=father.person)
    told = understand(seen("His name was Joost."), talk, {}, 2.0, 90.0)
    assert [(fact.topic, fact.values) for fact in told.facts] == [("father", ("Joost",))]


def test_a_refusal_before_a_sum_gets_no_reply() -> None:
    meaning = understand(seen("no time. 12 x 30 / 5"), Talk().asking("name", 0.0), {}, 1.0, 90.0)
    assert meaning.kind == "nothing" or not meaning.aloud


@pytest.mark.parametrize("text", ["how do I ask Nora for a dance?", "do you think Nora would like that?"])
def test_a_request_for_advice_is_not_answered_from_the_users_statements(text: str) -> None:
    told = understand(seen("my cousin Nora likes a dance"), Talk(), {}, 1.0, 90.0).said
    assert told and understand(seen(text), Talk(), {}, 1.0, 90.0, told).kind != "asked_told"


def test_a_question_for_what_the_user_cannot_do_is_answered_from_their_statements() -> None:
    told = understand(seen("I can not eat nuts"), Talk(), {}, 1.0, 90.0).said
    assert understand(seen("what can I not eat?"), Talk(), {}, 1.0, 90.0, told).kind == "asked_told"


def test_a_relative_clause_is_retold_as_a_sentence() -> None:
    said = understand(seen("there is a boy called Ole who shouts at me sometimes"), Talk(), {}, 1.0, 90.0).said
    assert [one.text for one in said] == ["there is a boy called Ole who shouts at you sometimes"]
    said = understand(seen("I saw my cousin Nora who lives in Ulm"), Talk(), {}, 1.0, 90.0).said
    assert not any("Nora who" in one.text for one in said if one.verb != "see")
