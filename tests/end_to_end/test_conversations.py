"""The sample conversations of the paper's appendix, and properties that hold for all conversations."""

from __future__ import annotations

from pathlib import Path

import pytest

from end_to_end.conversation import WORDS, Conversation, spoken_by


@pytest.mark.parametrize("backend", ["auto", "listen"])
def test_example_1_has_small_talk_and_questions_of_fact(tmp_path: Path, backend: str) -> None:
    with Conversation(tmp_path, {"wildtalk": {"backend": backend}}) as talk:
        assert spoken_by(talk.say("will it rain today")) == ["wildtalk"]
        assert spoken_by(talk.say("know if it's gonna rain today")) == ["wildtalk"]
        (answer,) = talk.say("when did it start to rain")
        assert (answer.module, "billion years" in answer.text) == ("genqa", True)
        (answer,) = talk.say("what is the capital of peru")
        assert (answer.module, "Lima" in answer.text) == ("genqa", True)


def test_in_example_2_the_agent_asks_a_question_and_remembers_the_answer(tmp_path: Path) -> None:
    with Conversation(tmp_path, {"persqa": {"topics": ["home"], "turns": 0}}) as talk:
        assert spoken_by(talk.say("what is your favorite animal")) in (["genqa"], ["agentqa"])
        asked = [line.text for line in talk.silence(60.0) if line.module == "persqa"]
        assert any("home" in text or "live" in text or "town" in text for text in asked)
        (reply,) = talk.say("hannover")
        assert (reply.module, "Hannover" in reply.text or "hannover" in reply.text) == ("persqa", True)
        talk.say("my name is ada")
    with Conversation(tmp_path) as talk:
        talk.say("hello")
        (question,) = talk.say("i am ada")
        assert (question.module, "Hannover" in question.text) == ("persqa", False)
        (reply,) = talk.say("in hannover")
        assert (reply.module, "Hannover" in reply.text) == ("persqa", True)


@pytest.mark.parametrize("backend", ["auto", "listen"])
def test_example_3_has_a_greeting_questions_about_the_agent_and_feelings(tmp_path: Path, backend: str) -> None:
    settings = {"emotion": {"shy": 1.0}, "wildtalk": {"backend": backend}, "persqa": {"topics": []}}
    with Conversation(tmp_path, settings) as talk:
        assert spoken_by(talk.say("Hello")) == ["hibye"]
        assert spoken_by(talk.say("how are you"))[:1] == ["agentqa"]
        said = talk.say("What are you up to today", 5.0)
        assert spoken_by(said)[0] == "wildtalk"
        assert "emotion" in spoken_by(said)
        for text in ("I see", "That sounds good", "It is Sunday"):  # the agent makes no offers in the first six turns
            talk.say(text)
        assert "agentqa" in spoken_by(talk.silence(120.0))
        assert spoken_by(talk.say("How old are you?"))[:1] == ["agentqa"]


def test_every_utterance_gets_exactly_one_answer(tmp_path: Path) -> None:
    said = (
        "hi",
        "i like tea",
        "who are you",
        "what is the highest mountain of nepal",
        "no",
        "thank you",
        "bye",
    )
    with Conversation(tmp_path, {"emotion": {"emoji": False}}, without=["fillers"]) as talk:
        for text in said:
            assert len(talk.say(text, 1.0)) == 1, text


def test_odd_inputs_do_not_stop_the_conversation(tmp_path: Path) -> None:
    odd = (
        "x" * 100_000,
        "🦊🦊🦊",
        "שלום, מה שלומך?",
        "\x1b[31mred\x00",
        "Wie geht es dir?",
        "   ",
        "?",
        "'; DROP TABLE--",
    )
    with Conversation(tmp_path, {"emotion": {"emoji": False}}) as talk:
        for text in odd:
            talk.say(text)
        (answer,) = talk.say("what are you up to")
        assert answer.text == WORDS.strip()
