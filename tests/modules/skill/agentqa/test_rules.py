"""The agent answers questions about itself before other modules, and leaves the rest to them."""

from __future__ import annotations

import itertools
import logging
from collections.abc import AsyncGenerator, Sequence
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import pytest

import ravestate as rs
from ravestate.language.chat import Message
from ravestate.modules import (
    agentqa,
    emotion,
    idle,
    interloc,
    nlp,
    ontology,
    rawio,
    verbaliser,
    wildtalk,
)
from ravestate.modules.meta.verbaliser.intents import Intent
from ravestate.modules.skill.agentqa import Router
from ravestate.testing import Simulation, simulate

pytestmark = pytest.mark.usefixtures("router")  # loads the model and the topics

chatter = rs.Module("chatter", requires=[rawio])
encyclopaedia = rs.Module("encyclopaedia", requires=[nlp, verbaliser])
asker = rs.Module("asker", requires=[idle, verbaliser])
found = encyclopaedia.signal("found")


@chatter.rule(when=rawio.input.changed, writes=rawio.output)
async def talk(ctx: rs.RuleContext) -> None:
    ctx[rawio.output] = "chatter"


@encyclopaedia.rule(when=rawio.input.changed & nlp.is_question, emits=found)
async def find(ctx: rs.RuleContext) -> None:
    ctx.emit(found)


@encyclopaedia.rule(when=found, writes=verbaliser.intent)
async def explain(ctx: rs.RuleContext) -> None:
    ctx[verbaliser.intent] = Intent("explain", phrases={"en": ["encyclopaedia"]})


@asker.rule(when=idle.bored, writes=verbaliser.intent, weight=1.1, cooldown=60.0)
async def ask(ctx: rs.RuleContext) -> None:
    ctx[verbaliser.intent] = Intent("ask", phrases={"en": ["What is your name?"]})


def start(tmp_path: Path, *modules: Any, own: str = "", bored: float = 1e6, **more: Any) -> Any:
    settings: dict[str, Any] = {
        "ontology": {"path": tmp_path / "memory.lbug"},
        "idle": {"bored_after": bored},
        "agentqa": {},
    }
    if own:
        (tmp_path / "own.yaml").write_text(own)
        settings["agentqa"]["life"] = tmp_path / "own.yaml"
    settings["agentqa"] |= more
    return simulate(agentqa, *modules, settings=settings)


def say(sim: Simulation, text: str) -> str:
    before = len(sim.said)
    sim.say(text)
    [said] = sim.said[before:]
    return said


def phrases(sim: Simulation, topic: str) -> tuple[str, ...]:
    life = sim.read(agentqa.life)
    assert life is not None
    return (*life.topics[topic].phrases, *life.topics[topic].otherwise)


def test_agentqa_alone_answers_questions_about_the_agent(tmp_path: Path) -> None:
    own = """
    facts: {name: Robin, hobbies: [chess], friends: [Ada, Bob]}
    topics:
      hobbies: {phrases: "I play {hobbies}."}
      friends: {phrases: "{friends}, of course."}
      name: {phrases: "{name}."}
    """
    with start(tmp_path, chatter, encyclopaedia, own=own) as sim:
        assert say(sim, "What are your hobbies?") == "I play chess."
        assert say(sim, "tell me about your friends") == "Ada and Bob, of course."
        assert say(sim, "hi, whats ur name") == "Robin."
        assert say(sim, "what is Robin called?") == "Robin."
        assert sim.failures == []


@pytest.mark.parametrize(
    ("text", "who"),
    [
        ("What is my name?", "encyclopaedia"),
        ("My father is a baker.", "chatter"),
        ("", "chatter"),
        ("x" * 100_000, "chatter"),
        ("how old are " * 9_000, "encyclopaedia"),
        ("🙂\x00\x1b[2J مرحبا", "chatter"),
    ],
)
def test_all_other_utterances_are_left_to_other_modules(text: str, who: str, tmp_path: Path) -> None:
    with start(tmp_path, chatter, encyclopaedia) as sim:
        assert say(sim, text) == who
        assert sim.failures == []


def test_agentqa_wins_against_another_answering_module_whatever_the_order_of_modules() -> None:
    for modules in ((agentqa, encyclopaedia), (encyclopaedia, agentqa)):
        pair = {"agentqa:answer", "encyclopaedia:explain"}
        [conflict] = [one for one in rs.compile(*modules).conflicts() if {one.first, one.second} == pair]
        assert conflict.winner == "agentqa:answer" and conflict.margin > 1.0 and not conflict.tie


@pytest.mark.parametrize(
    ("text", "topic"),
    [
        ("I want to kill myself", "distress"),
        ("who are you? I want to die", "distress"),
        ("you are a stupid piece of junk", "insult"),
    ],
)
def test_the_reply_to_distress_or_an_insult_comes_before_any_other_answer(
    text: str, topic: str, tmp_path: Path
) -> None:
    busy = rs.Module("busy", requires=[verbaliser])

    @busy.rule(when=rawio.input.changed.where(bool), writes=verbaliser.intent, weight=9.0)
    async def insist(ctx: rs.RuleContext) -> None:
        ctx[verbaliser.intent] = Intent("insist", phrases={"en": ["busy"]})

    own = f"topics: {{{topic}: {{phrases: 'I hear you.'}}}}"
    with start(tmp_path, chatter, encyclopaedia, busy, own=own) as sim:
        assert say(sim, text) == "I hear you."
        assert say(sim, "it is warm") == "busy"


def test_other_rules_can_react_to_the_topic_of_a_remark(tmp_path: Path) -> None:
    nurse = rs.Module("nurse", requires=[agentqa])
    called: rs.Slot[str] = nurse.slot("called", "")

    @nurse.rule(when=agentqa.remarked.where(lambda remark: remark.topic == "distress"), writes=called)
    async def call(ctx: rs.RuleContext) -> None:
        ctx[called] = ctx.payload(agentqa.remarked).text

    with start(tmp_path, nurse) as sim:
        sim.say("Hi! I want to die!")
        assert sim.read(called) == "i want to die"


def test_a_user_in_distress_hears_the_helplines(tmp_path: Path) -> None:
    with start(tmp_path, own="facts: {helplines: the number 123}") as sim:
        assert "the number 123" in say(sim, "I want to kill myself")
    with start(tmp_path, own="facts: {helplines: ~}") as sim:
        assert "doctor" in say(sim, "I want to kill myself")


def test_a_question_repeated_thousands_of_times_is_answered_once(tmp_path: Path) -> None:
    with start(tmp_path, chatter) as sim:
        sim.put(agentqa.clock, lambda: datetime(2026, 3, 1, 12, 5, tzinfo=UTC))
        assert "2 years" in say(sim, "How old are you? " * 6_000)


def test_the_answer_to_how_are_you_is_the_agents_mood(tmp_path: Path) -> None:
    own = "topics: {how_are_you: {phrases: 'I am {mood}. And you?'}}"
    with start(tmp_path, own=own) as sim:
        assert say(sim, "how are you") == "I am fine. And you?"
        sim.put(agentqa.mood, "a little shy")
        assert say(sim, "Hello, how are you today?") == "I am a little shy. And you?"


def test_the_agents_age_changes_on_its_birthday(tmp_path: Path) -> None:
    own = "{facts: {born: 2020-03-02}, topics: {age: {phrases: '{age}'}}}"
    with start(tmp_path, own=own) as sim:
        sim.put(agentqa.clock, lambda: datetime(2026, 3, 1, 12, 5, tzinfo=UTC))
        assert say(sim, "how old are you") == "5 years"
        sim.put(agentqa.clock, lambda: datetime(2026, 3, 2, 0, 0, tzinfo=UTC))
        assert say(sim, "how old are you") == "6 years"


def test_the_agent_tells_the_time_and_the_date_of_its_clock(tmp_path: Path) -> None:
    with start(tmp_path, chatter, encyclopaedia) as sim:
        sim.put(agentqa.clock, lambda: datetime(2026, 3, 1, 9, 5, tzinfo=UTC))
        for text in ("what time is it?", "Do you know what time it is?", "whats the time"):
            assert "09:05" in say(sim, text)
        sim.put(agentqa.clock, lambda: datetime(2026, 3, 2, 23, 59, tzinfo=UTC))
        for text in ("what day is it today?", "what's the date?"):
            assert "Monday, 2 March 2026" in say(sim, text)
        assert say(sim, "What time is it in Tokyo?") == "encyclopaedia"


@pytest.mark.parametrize(
    ("question", "answer", "topic"),
    [
        ("Hello! How are you?", "I'm fine thanks, and you?", "how_are_you"),
        ("Hello! How are you?", "fine. you?", "how_are_you"),
        ("Where do you live?", "in Ulm. What about you?", "home"),
        ("What is your name?", "what's yours?", "name"),
        ("What do you do in your free time?", "sailing, and you", "hobbies"),
    ],
)
def test_the_user_can_answer_a_question_and_ask_it_back(question: str, answer: str, topic: str, tmp_path: Path) -> None:
    own = f"topics: {{{topic}: {{phrases: 'This is my {topic}. And yours?'}}}}"
    with start(tmp_path, chatter, encyclopaedia, own=own) as sim:
        sim.put(rawio.output, question)
        # The user has already answered the question, so the agent leaves "And yours?" out.
        assert say(sim, answer) == f"This is my {topic}."


def test_the_words_and_you_without_an_earlier_question_are_left_to_other_modules(tmp_path: Path) -> None:
    with start(tmp_path, chatter) as sim:
        assert say(sim, "and you") == "chatter"


def test_a_yes_no_question_about_one_thing_is_answered_with_yes_or_no(tmp_path: Path) -> None:
    with start(tmp_path, chatter, own="facts: {languages: [English, Welsh]}") as sim:
        for language in ("English", "Welsh", "German", "Danish"):
            yes = language in ("English", "Welsh")
            said = say(sim, f"Do you speak {language}?")
            assert said.startswith(("Yes", "Oh yes") if yes else ("No, ", "Not that")), (language, said)
        assert not say(sim, "what can you do?").startswith(("Yes", "No"))


def test_the_agent_explains_what_it_does_with_the_users_words(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    with start(tmp_path, chatter, encyclopaedia) as sim:
        for text in ("why do you want to know?", "what do you do with what I tell you?"):
            assert "forget me" in say(sim, text)
        assert say(sim, "why do cats sleep") == "encyclopaedia"
    (tmp_path / "memory.lbug").unlink()
    (tmp_path / "memory.lbug").write_text("this is no memory")
    with caplog.at_level(logging.CRITICAL, "ravestate"), start(tmp_path) as sim:
        assert "no memory" in say(sim, "why do you want to know?")


def test_after_a_wish_for_quiet_the_agent_is_silent_until_the_user_speaks(tmp_path: Path) -> None:
    with start(tmp_path, chatter, bored=5.0) as sim:
        said = say(sim, "Shut up!")
        assert said != "chatter" and "?" not in said
        sim.advance(300.0)
        assert len(sim.said) == 1
        sim.say("hello")
        assert len(sim.said) == 2


def test_the_same_phrase_never_comes_twice_in_a_row(tmp_path: Path) -> None:
    with start(tmp_path) as sim:
        said = [say(sim, "where do you live") for _ in range(8)]
        assert all(first != second for first, second in itertools.pairwise(said))


def test_topics_without_facts_are_left_to_other_modules(tmp_path: Path) -> None:
    own = "{facts: {home: ~}, topics: {home: {phrases: 'In {home}.'}}}"
    with start(tmp_path, chatter, own=own) as sim:
        assert say(sim, "where do you live") == "chatter"
        assert "its phrases lack a fact" in str(sim.explain("agentqa:answer"))


def test_explain_says_why_agentqa_gave_no_answer(tmp_path: Path) -> None:
    with start(tmp_path, chatter) as sim:
        say(sim, "what are you up to today")
        assert "an example that is not about me is nearer" in str(sim.explain("agentqa:understand"))


def test_answers_come_from_memory_and_change_with_the_life_file(tmp_path: Path) -> None:
    own = "{facts: {friends: [Ada]}, topics: {friends: {phrases: '{friends}', otherwise: Nobody.}}}"
    with start(tmp_path, own=own) as sim:
        memory = sim.read(ontology.memory)
        assert memory is not None
        [node] = memory.find("Robot").result()
        assert [friend["name"] for friend in memory.related(node, "friend_of").result()] == ["Ada"]
        memory.relate(node, "friend_of", memory.create("Person", name="Bob").result()).result()
        assert say(sim, "who are your friends") == "Ada and Bob"
    with start(tmp_path, own=own.replace("Ada", "Cy")) as sim:
        assert say(sim, "who are your friends") == "Cy"


def test_without_memory_answers_come_from_the_life_file(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    (tmp_path / "memory.lbug").write_text("this is no memory")
    own = "{facts: {friends: [Ada]}, topics: {friends: {phrases: '{friends}'}}}"
    with start(tmp_path, own=own) as sim:
        assert say(sim, "who are your friends") == "Ada"
        assert sim.failures == []
    told = [record for record in caplog.records if record.levelno >= logging.WARNING]
    assert [record.name for record in told] == [
        "ravestate.ontology.open_up"
    ]  # only ontology logs the error, and only once


def test_agentqa_still_answers_after_memory_has_failed(tmp_path: Path) -> None:
    own = "{facts: {friends: [Ada]}, topics: {friends: {phrases: '{friends}'}}}"
    with start(tmp_path, own=own) as sim:
        memory = sim.read(ontology.memory)
        assert memory is not None
        memory.close().result()
        assert say(sim, "who are your friends") == "Ada"


def test_without_the_sentence_model_other_modules_answer_and_an_error_names_the_missing_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from ravestate.modules.skill.agentqa import rules

    class Without:
        def __init__(self, folder: Path) -> None:
            self.folder = folder

        def __call__(self, life: Any) -> Router:
            from ravestate.language import Encoder

            return Router(life, Encoder(self.folder))

    monkeypatch.setattr(rules, "router_of", Without(tmp_path))
    with start(tmp_path, chatter) as sim:
        assert say(sim, "how old are you") == "chatter"
        assert "model.onnx" in str(sim.failures)


def test_after_a_long_silence_the_agent_once_offers_to_answer_questions(tmp_path: Path) -> None:
    with start(tmp_path, chatter, bored=5.0) as sim:
        for turn in range(6):
            sim.say(f"it rains, for the {turn}. time")
        sim.advance(50.0)
        assert len(sim.said) == 6
        sim.advance(20.0)
        assert len(sim.said) == 7
        assert say(sim, "How old are you?") not in ("chatter", sim.said[6])
        sim.advance(200.0)
        assert len(sim.said) == 8


def test_the_agent_offers_nothing_in_the_first_turns_or_while_the_user_talks(tmp_path: Path) -> None:
    with start(tmp_path, chatter, bored=5.0) as sim:
        sim.say("it rains")
        sim.advance(200.0)
        assert len(sim.said) == 1
        for turn in range(9):
            sim.say(f"it rains, for the {turn}. time")
            sim.advance(50.0)
        assert len(sim.said) == 10
        sim.advance(100.0)
        assert len(sim.said) == 11


def test_all_modules_take_the_agents_name_from_the_life_file(tmp_path: Path) -> None:
    told: list[str] = []

    class Model:
        async def load(self, progress: Any = None) -> None: ...

        async def close(self) -> None: ...

        async def stream(self, messages: Sequence[Message], **_: Any) -> AsyncGenerator[str, None]:
            told.append(messages[0].text)
            yield "Robin: Thank you."

    listener = rs.Module("listener", requires=[nlp, emotion])
    noticed: rs.Slot[tuple[str, ...]] = listener.slot("noticed", ())

    @listener.rule(when=nlp.about_agent & emotion.shy, writes=noticed)
    async def notice(ctx: rs.RuleContext) -> None:
        ctx[noticed] = (*ctx[noticed], "praise")

    with start(tmp_path, wildtalk, listener, own="facts: {name: Robin}") as sim:
        assert sim.read(interloc.agent) == "Robin"
        sim.put(wildtalk.model, Model())
        sim.say("Robin is clever.")
        assert sim.read(noticed) == ("praise",)
        assert sim.said[0] == "Thank you."
        assert "You are Robin," in told[0]


def test_an_answer_is_a_phrase_of_its_topic(tmp_path: Path) -> None:
    with start(tmp_path) as sim:
        assert say(sim, "do you have siblings") in phrases(sim, "siblings")
        assert say(sim, "what is your favorite animal") in (
            "My favourite animal is the octopus.",
            "My favourite animal? That is the octopus.",
        )
