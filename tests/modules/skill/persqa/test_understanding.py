"""Laws for any utterance. The set ``persqa_facts`` measures how well utterances are understood."""

import pytest

from ravestate.modules.skill.persqa.talk import Talk
from ravestate.modules.skill.persqa.understanding import Heard, understand


def talk_about(topic: str) -> Talk:
    return Talk().asking(topic, 0.0).speaking()


@pytest.mark.parametrize(
    "text", ["x" * 100_000, "a, " * 30_000, "i live in " * 10_000, "no " * 30_000, "my name is " * 9_000]
)
def test_a_long_text_is_read_at_once_and_only_at_its_beginning(text: str) -> None:
    for topic in ("name", "home", "hobby", "friend", "club"):
        meaning = understand(Heard(text), talk_about(topic), {}, 1.0, 90.0)
        assert all(len(value) <= 500 for fact in meaning.facts for value in fact.values)


@pytest.mark.parametrize("text", ["", "   ", "...", "?!", "🙂", "\x00\x1b[31m"])
def test_empty_utterances_mean_nothing(text: str) -> None:
    assert understand(Heard(text), talk_about("name"), {}, 1.0, 90.0).kind == "nothing"
    assert understand(Heard(text), Talk(), {}, 1.0, 90.0).kind == "nothing"


def test_an_answer_counts_only_while_its_question_waits() -> None:
    heard = Heard("hannover", tokens=("hannover",), pos=("PROPN",))
    assert understand(heard, talk_about("home"), {}, 90.0, 90.0).kind == "told"
    assert understand(heard, talk_about("home"), {}, 91.0, 90.0).kind == "nothing"


def test_a_denial_of_what_is_not_known_means_nothing() -> None:
    heard = Heard("i don't live in hannover")
    assert understand(heard, Talk(), {}, 1.0, 90.0).kind == "nothing"
    assert understand(heard, Talk(), {"home": ("Hannover",)}, 1.0, 90.0).kind == "told"
