"""Whole conversations in virtual time, with a real memory in a file."""

from __future__ import annotations

import asyncio
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

import ravestate as rs
from modules.skill.persqa.conftest import Look
from ravestate.errors import PlatformError
from ravestate.modules import hibye, idle, interloc, nlp, ontology, persqa, rawio, verbaliser
from ravestate.modules.meta.verbaliser.phrases import PhraseBook
from ravestate.testing import Simulation, simulate

pytestmark = pytest.mark.usefixtures("reader")

PHRASES = Path(persqa.__file__).with_name("phrases.yaml")
BOOK = PhraseBook.load([PHRASES])


def chatter(seconds: float = 0.0) -> rs.Module:
    """Return a module for small talk."""
    talk = rs.Module("chatter", requires=[rawio])

    @talk.rule(when=rawio.input.changed, writes=rawio.output, until=rawio.input.changed)
    async def chat(ctx: rs.RuleContext) -> None:
        if seconds:
            await ctx.sleep(seconds)
        ctx[rawio.output] = "I see."

    return talk


def knower() -> rs.Module:
    """Return a module that answers questions."""
    module = rs.Module("knower", requires=[rawio, nlp])

    @module.rule(when=nlp.is_question, writes=rawio.output)
    async def answer(ctx: rs.RuleContext) -> None:
        ctx[rawio.output] = "I know it."

    return module


def agent(file: Path | None, *others: Any, **settings: Any) -> Simulation:
    where: dict[str, Any] = {"path": file} if file is not None else {"path": "/dev/null/no/memory.lbug"}
    chosen = {"confirm": False, "gap": 0.0, "turns": 0, **settings}
    return simulate(
        persqa,
        chatter(),
        *others,
        settings={"ontology": where, "persqa": chosen, "idle": {"bored_after": 5.0, "answer_time": 12.0}},
    )


def meant(text: str, intent: str) -> bool:
    """Return whether `text` is a phrase of `intent`, with any parameters."""
    for template in BOOK.templates(intent):
        pieces = [piece.partition("}")[2] if index else piece for index, piece in enumerate(template.text.split("{"))]
        at = 0
        for piece in pieces:
            at = text.find(piece, at)
            if at < 0:
                break
            at += len(piece)
        else:
            if text.startswith(pieces[0]) and text.endswith(pieces[-1]):
                return True
    return False


def asked(sim: Simulation) -> str:
    """Say nothing for 6 s, and return the topic that the agent then asks about."""
    before = len(sim.said)
    sim.advance(6.0)
    question = sim.read(persqa.talk).question
    assert len(sim.said) == before + 1 and question is not None, sim.said[before:]
    assert meant(sim.said[-1], f"ask_{question.topic}"), sim.said[-1]
    return question.topic


def answers(sim: Simulation, text: str) -> str:
    """Say a text, and return the agent's only answer."""
    before = len(sim.said)
    sim.say(text)
    assert len(sim.said) == before + 1, (text, sim.said[before:])
    return sim.said[-1]


ANSWERS = {
    "name": "ada",
    "home": "hannover",
    "origin": "i come from new york",
    "hobby": "chess, and a bit of football",
    "occupation": "i'm a baker",
    "employer": "at siemens",
    "subject": "physics",
    "university": "the TU",
    "friend": "tom and anna",
    "club": "the chess club",
}
STORED = {
    "lives_in": ["Hannover"],
    "comes_from": ["New York"],
    "has_hobby": ["chess", "football"],
    "works_as": ["baker"],
    "works_for": ["Siemens"],
    "studies": ["physics"],
    "studies_at": ["the TU"],
    "friend_of": ["Tom", "Anna"],
    "member_of": ["the chess club"],
}


def test_in_a_first_conversation_the_agent_learns_about_the_user(file: Path, look: Look) -> None:
    topics: list[str] = []
    with agent(file) as sim:
        sim.say("I talked about work and the university at breakfast")
        for _ in ANSWERS:
            topic = asked(sim)
            topics.append(topic)
            assert meant(answers(sim, ANSWERS[topic]), f"learned_{topic}")
        before = len(sim.said)
        sim.advance(300.0)
        assert len(sim.said) == before  # there is nothing left to ask
        assert sim.failures == []
    assert topics[0] == "name" and set(topics) == set(ANSWERS)
    assert look() == {"Ada": STORED, "Tom": {}, "Anna": {}}


def test_the_agent_remembers_the_user_in_another_session(file: Path) -> None:
    with agent(file) as sim:
        sim.say("my name is ada and i live in hannover")
    with agent(file) as sim:
        assert asked(sim) == "name"
        said = answers(sim, "it's ada")
        assert meant(said, "welcome_back")
        assert said.endswith("ou told me that you live in Hannover.")
        assert "Ada" in said
        assert asked(sim) == "origin"  # the agent does not ask for the home, which it knows
        assert answers(sim, "where do i live").endswith("you live in Hannover.")


def test_the_agent_remembers_the_user_in_another_process(file: Path) -> None:
    code = """
import sys
from ravestate.modules import persqa
from ravestate.testing import simulate
with simulate(persqa, settings={"ontology": {"path": sys.argv[1]}, "persqa": {"confirm": False}}) as sim:
    for text in sys.argv[2:]:
        sim.say(text)
    print(sim.said[-1])
"""

    with agent(file) as sim:
        sim.say("i'm called Ada")
        sim.say("i live in hannover")
    command = [sys.executable, "-c", code, str(file), "i'm called ada"]
    said = subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip()
    assert meant(said, "welcome_back") and "you live in Hannover" in said


def test_the_sample_conversation_of_the_paper_is_reproduced(file: Path, look: Look) -> None:
    with agent(file, knower(), topics=["home"]) as sim:
        assert answers(sim, "what is your favorite animal") == "I know it."
        assert asked(sim) == "home"
        said = answers(sim, "hannover")
        assert meant(said, "learned_home") and "persqa:respond" in sim.fired
        sim.say("my name is ada")
    assert look() == {"Ada": {"lives_in": ["Hannover"]}}  # Ada told the agent her home before her name


@pytest.mark.parametrize("phrase", ["Which town do you call your home?", "Oh, I should visit {home}."])
def test_the_agent_has_the_phrases_from_the_papers_sample_conversation(phrase: str) -> None:
    texts = [template.text for intent in ("ask_home", "learned_home") for template in BOOK.templates(intent)]
    assert phrase in texts


def test_each_intent_has_three_phrases_and_each_topic_has_one_that_needs_no_extra_parameter() -> None:
    for intent in BOOK.intents:
        assert len(BOOK.templates(intent)) >= 3, intent
    for topic in persqa.Settings().topics:
        needs = [template.parameters for template in BOOK.templates(f"ask_{topic}")]
        assert not min(needs, key=len) or topic == "university"
        assert min([t.parameters for t in BOOK.templates(f"learned_{topic}")], key=len) <= {topic}


# ------------------------------------------------------------------------------------ when the agent asks


@pytest.mark.parametrize("text", ["I'd rather not say", "none of your business", "no"])
def test_a_refused_topic_is_not_asked_again(file: Path, text: str) -> None:
    with agent(file) as sim:
        assert asked(sim) == "name"
        assert meant(answers(sim, text), "declined")
        topics = [asked(sim)]
        for _ in range(12):
            sim.say("hm, well.")
            before = len(sim.said)
            sim.advance(6.0)
            if len(sim.said) > before:
                topics.append(sim.read(persqa.talk).question.topic)  # pyright: ignore[reportOptionalMemberAccess]
        assert "name" not in topics and "home" in topics
        assert meant(answers(sim, "what is my name?"), "recall_declined")


def test_the_user_can_answer_that_they_have_none_or_do_not_know(file: Path, look: Look) -> None:
    with agent(file, topics=["hobby", "occupation", "friend", "employer"]) as sim:
        sim.say("my name is ada")
        assert asked(sim) == "hobby"
        assert meant(answers(sim, "no"), "none")
        sim.say("that was hard work")
        assert asked(sim) == "occupation"
        assert meant(answers(sim, "i don't know"), "unsure")
        assert asked(sim) == "friend"
        assert meant(answers(sim, "nobody"), "none")
        before = len(sim.said)
        sim.advance(100.0)
        assert len(sim.said) == before
        assert sim.read(persqa.facts) == {"hobby": (), "friend": ()}
        assert meant(answers(sim, "what is my hobby"), "recall_none")
    assert look() == {"Ada": {}}


@pytest.mark.parametrize("text", ["I was away.", "sorry, I was in the kitchen", "I was asleep"])
def test_an_excuse_is_no_answer(file: Path, text: str) -> None:
    with agent(file, topics=["hobby"]) as sim:
        assert asked(sim) == "hobby"
        assert answers(sim, text) == "I see."  # small talk
        assert dict(sim.read(persqa.facts)) == {} and not sim.read(persqa.talk).closed
        sim.say("chess")
        assert sim.read(persqa.facts) == {"hobby": ("chess",)}


def test_the_agent_asks_for_details_if_the_user_just_says_yes(file: Path) -> None:
    with agent(file, topics=["hobby"]) as sim:
        assert asked(sim) == "hobby"
        assert meant(answers(sim, "yes"), "which")
        assert meant(answers(sim, "chess"), "learned_hobby")


def test_after_two_unanswered_questions_the_agent_waits_for_the_user(file: Path) -> None:
    with agent(file) as sim:
        sim.advance(600.0)
        assert len(sim.said) == 2
        sim.say("sorry, I was away.")
        sim.advance(6.0)
        assert len(sim.said) == 4  # the answer of the small talk, and a third question


def test_the_agent_leaves_the_user_time_to_answer_a_question(file: Path) -> None:
    with agent(file, gap=30.0) as sim:
        assert asked(sim) == "name"
        sim.advance(25.0)
        assert len(sim.said) == 1
        assert meant(answers(sim, "ada"), "learned_name")


def test_after_goodbye_nothing_is_asked(file: Path) -> None:
    with agent(file, hibye) as sim:
        assert asked(sim) == "name"
        sim.say("bye")
        assert "hibye:answer_goodbye" in sim.fired
        before = len(sim.said)
        sim.advance(300.0)
        assert len(sim.said) == before


def test_after_some_time_a_text_no_longer_counts_as_the_answer_to_a_question(file: Path) -> None:
    with agent(file, topics=["home"], within=40.0, gap=1000.0) as sim:
        assert asked(sim) == "home"
        sim.advance(60.0)
        assert answers(sim, "hannover") == "I see."
        assert dict(sim.read(persqa.facts)) == {}


def test_a_no_to_the_question_of_another_module_is_not_taken_for_an_answer(file: Path) -> None:
    host = rs.Module("host", requires=[rawio])
    offer = host.signal("offer")

    @host.rule(when=offer, writes=rawio.output)
    async def speak(ctx: rs.RuleContext) -> None:
        ctx[rawio.output] = "Shall we play a game?"

    with agent(file, host, topics=["hobby"]) as sim:
        assert asked(sim) == "hobby"
        sim.emit(offer)
        assert answers(sim, "no") == "I see."
        assert meant(answers(sim, "chess"), "learned_hobby")


def test_persqa_takes_turns_with_another_module_in_silences(file: Path) -> None:
    host = rs.Module("host", requires=[verbaliser, idle])

    @host.rule(when=idle.bored, writes=verbaliser.intent, cooldown=20.0)
    async def speak(ctx: rs.RuleContext) -> None:
        ctx[verbaliser.intent] = "bored"

    with agent(file, host) as sim:
        for _ in range(4):
            sim.advance(6.0)
            sim.say("hm, well.")
        by = [name for name in sim.fired if name in ("persqa:ask", "host:speak")]
    assert {by.count("persqa:ask"), by.count("host:speak")} == {2}


# ------------------------------------------------------------------------------------ the user comes first


def test_the_users_question_is_answered_first_and_they_can_answer_the_agents_question_later(file: Path) -> None:
    with agent(file, knower()) as sim:
        assert asked(sim) == "name"
        assert answers(sim, "why do you ask?") == "I know it."
        assert meant(answers(sim, "ada"), "learned_name")


def test_facts_beside_a_question_are_learnt_without_a_reply(file: Path, look: Look) -> None:
    with agent(file, knower()) as sim:
        sim.say("my name is ada")
        assert asked(sim) == "home"
        assert answers(sim, "hannover, and you?") == "I know it."
        assert answers(sim, "i work as a baker. what do you do?") == "I know it."
    assert look() == {"Ada": {"lives_in": ["Hannover"], "works_as": ["baker"]}}


@pytest.mark.parametrize("text", ["what a nice day", ""])
def test_small_talk_is_left_to_other_modules_without_delay(file: Path, text: str) -> None:
    with agent(file) as sim:
        assert asked(sim) == "name"
        began = sim.now
        assert answers(sim, text) == "I see."
        assert sim.now == began
        assert sim.read(persqa.who) is None


def test_hibye_answers_a_greeting_but_persqa_learns_the_name_in_a_greeting(file: Path) -> None:
    with agent(file, hibye) as sim:
        assert asked(sim) == "name"
        answers(sim, "hello")
        assert "hibye:answer_hello" in sim.fired
        assert meant(answers(sim, "hello, i'm called ada"), "learned_name")


def test_persqa_interrupts_small_talk_and_the_user_interrupts_persqa(file: Path) -> None:
    with simulate(persqa, chatter(10.0), settings={"ontology": {"path": file}}) as sim:
        sim.say("it is quiet here")
        sim.advance(3.0)
        assert meant(answers(sim, "my name is ada"), "learned_name")
        sim.context.put(rawio.input, "i live in bremen")
        sim.context.put(rawio.input, "i work as a baker")
        sim.settle()
        assert dict(sim.read(persqa.facts)) == {"home": ("Bremen",), "occupation": ("baker",)}
        sim.advance(30.0)
        assert "I see." not in sim.said


@pytest.mark.parametrize("heard", ["whole", "half"])
def test_a_spoken_question_counts_only_if_the_user_heard_it(file: Path, heard: str) -> None:
    with agent(file) as sim:
        sim.say("Hello.")
        sim.advance(30.0)
        question = sim.said[-1]
        assert question.endswith("?") and sim.read(persqa.talk).question is not None
        sim.put(rawio.heard, question if heard == "whole" else question.rsplit(maxsplit=1)[0])
        assert (sim.read(persqa.talk).question is not None) == (heard == "whole")


def test_an_utterance_at_the_moment_of_boredom_is_understood(file: Path) -> None:
    with agent(file) as sim:
        sim.advance(4.999)
        sim.context.put(rawio.input, "my name is ada")
        sim.context.emit(idle.bored)
        sim.settle()
        assert sim.read(persqa.who)["name"] == "Ada"  # pyright: ignore[reportOptionalSubscript]


# ------------------------------------------------------------------------------------ many things at once


def at_once(sim: Simulation, *texts: str) -> None:
    """Give the agent all these texts before it reads any of them."""
    for text in texts:
        sim.context.put(rawio.input, text)
    sim.settle()
    assert sim.failures == []


def test_the_facts_of_simultaneous_utterances_are_all_learnt(file: Path, look: Look) -> None:
    with agent(file) as sim:
        at_once(sim, "my name is ada", "i live in ulm", "my hobby is chess", "i work as a baker")
        assert any(meant(said, "learned_name") for said in sim.said)  # the answers may come in any order
        at_once(sim, "i moved to bremen", "my hobby is judo", "my dog is called rex", "my friend is called tom")
        assert dict(sim.read(persqa.facts)) == {
            "home": ("Bremen",),
            "hobby": ("chess", "judo"),
            "dog": ("Rex",),
            "occupation": ("baker",),
            "friend": ("Tom",),
        }
    known = {
        "lives_in": ["Bremen"],
        "has_hobby": ["chess", "judo"],
        "has_pet": ["Rex"],
        "works_as": ["baker"],
        "friend_of": ["Tom"],
    }
    assert look() == {"Ada": known, "Tom": {}}


def test_facts_are_learnt_even_if_the_analysis_takes_long(
    file: Path, look: Look, monkeypatch: pytest.MonkeyPatch
) -> None:
    loaded = asyncio.Event()

    async def when_loaded(function: Any, *arguments: Any) -> Any:
        await loaded.wait()
        return function(*arguments)

    monkeypatch.setattr("ravestate.modules.meta.nlp.rules.asyncio.to_thread", when_loaded)
    with simulate(persqa, settings={"ontology": {"path": file}}) as sim:
        at_once(sim, "my name is ada", "i live in ulm")
        sim.advance(30.0)
        loaded.set()
        sim.settle()
        assert meant(sim.said[0], "learned_name")
    assert look() == {"Ada": {"lives_in": ["Ulm"]}}


def test_a_user_can_go_on_talking_while_memory_looks_them_up(file: Path, look: Look) -> None:
    with agent(file) as sim:
        at_once(sim, "my name is ada", "i live in ulm", "my hobby is chess")
    with agent(file) as sim:
        at_once(sim, "my name is ada", "i live in bremen", "my hobby is judo")
        assert any(meant(said, "welcome_back") for said in sim.said)  # the answers may come in any order
        assert dict(sim.read(persqa.facts)) == {"home": ("Bremen",), "hobby": ("chess", "judo")}
    assert look() == {"Ada": {"lives_in": ["Bremen"], "has_hobby": ["chess", "judo"]}}


def test_two_agents_with_the_same_memory_know_one_person(file: Path, look: Look) -> None:
    with agent(file) as one, agent(file) as other:
        for sim in (one, other):
            sim.context.put(rawio.input, "my name is ada")
        for sim in (one, other):
            sim.settle()
        assert one.read(persqa.who) == other.read(persqa.who)
        one.say("my hobby is chess")
        other.say("my hobby is judo")
        one.say("my hobby is golf")
        one.say("no, ludo")
    assert look() == {"Ada": {"has_hobby": ["chess", "judo", "ludo"]}}


# ------------------------------------------------------------------------------------ corrections


def test_a_new_user_who_corrects_their_name_is_renamed(file: Path, look: Look) -> None:
    with agent(file) as sim:
        sim.say("my name is ada and i live in ulm")
        first = sim.read(persqa.who)
        assert meant(answers(sim, "no, my name is bob"), "renamed")
        second = sim.read(persqa.who)
        assert first is not None and second is not None and first.id == second.id
    assert look() == {"Bob": {"lives_in": ["Ulm"]}}


def test_nonsense_after_an_introduction_does_not_rename_the_user(file: Path, look: Look) -> None:
    with agent(file) as sim:
        sim.say("hi im nora")
        sim.say("asdkjh qwe")
    assert look() == {"Nora": {}}


def test_a_user_taken_for_another_person_does_not_change_that_persons_facts(file: Path, look: Look) -> None:
    with agent(file) as sim:
        sim.say("my name is ada and i live in hannover")
    with agent(file) as sim:
        assert meant(answers(sim, "my name is ada"), "welcome_back")
        sim.say("i live in bremen")
        assert meant(answers(sim, "no, my name is bob"), "renamed")
        assert dict(sim.read(persqa.facts)) == {"home": ("Bremen",)}
    assert look() == {"Ada": {"lives_in": ["Hannover"]}, "Bob": {"lives_in": ["Bremen"]}}


def test_a_new_user_who_corrects_their_name_can_be_a_known_person(file: Path, look: Look) -> None:
    with agent(file) as sim:
        sim.say("my name is bob and i live in hannover")
    with agent(file) as sim:
        sim.say("my name is rob and i work as a baker")
        said = answers(sim, "no, it's bob")
        assert meant(said, "welcome_back") and "Hannover" in said
    assert look() == {"Bob": {"lives_in": ["Hannover"], "works_as": ["baker"]}}


@pytest.mark.parametrize(
    "text",
    ["no, bremen", "i moved to bremen"],
)
def test_a_home_is_corrected(file: Path, look: Look, text: str) -> None:
    with agent(file) as sim:
        sim.say("my name is ada")
        assert asked(sim) == "home"
        sim.say("hannover")
        assert meant(said := answers(sim, text), "corrected") and "you live in Bremen" in said
    assert look() == {"Ada": {"lives_in": ["Bremen"]}}


def test_a_no_to_the_next_question_does_not_correct_the_last_answer(file: Path) -> None:
    with agent(file, topics=["home", "origin"]) as sim:
        assert asked(sim) == "home"
        sim.say("hannover")
        assert asked(sim) == "origin"
        assert meant(answers(sim, "no, from bremen"), "learned_origin")
        assert dict(sim.read(persqa.facts)) == {"home": ("Hannover",), "origin": ("Bremen",)}
        assert meant(answers(sim, "ulm, not bremen"), "corrected")
        assert dict(sim.read(persqa.facts)) == {"home": ("Hannover",), "origin": ("Ulm",)}


def test_a_recalled_fact_can_be_corrected(file: Path, look: Look) -> None:
    with agent(file) as sim:
        sim.say("my name is ada")
        sim.say("i live in hannover")
        for _ in range(4):
            sim.say("hm, well.")
        assert meant(answers(sim, "where do i live?"), "recall")
        assert meant(answers(sim, "no, in bremen"), "corrected")
        assert meant(answers(sim, "do i live in hannover?"), "deny")
    assert look() == {"Ada": {"lives_in": ["Bremen"]}}


@pytest.mark.parametrize("text", ["Hi, I'm Bob.", "i'm ada"])
def test_an_introduction_counts_even_if_the_agent_has_not_asked(file: Path, text: str) -> None:
    with agent(file, hibye) as sim:
        assert meant(answers(sim, text), "learned_name")


def test_an_outdated_fact_is_removed_and_asked_again(file: Path, look: Look) -> None:
    with agent(file) as sim:
        sim.say("my name is ada")
        sim.say("i live in hannover")
        assert meant(answers(sim, "i don't live there any more"), "struck")
        sim.put(idle.sorrow, 0)
        assert asked(sim) == "home"
    assert look() == {"Ada": {}}


@pytest.mark.parametrize(
    ("told", "ended", "question", "value"),
    [
        ("i live in leeds", "i don't live in leeds any more", "where do i live?", "you live in leeds"),
        ("my hobby is chess", "i gave up chess", "what is my hobby?", "your hobby is chess"),
    ],
)
def test_an_ended_fact_is_not_recalled_from_an_earlier_statement(
    file: Path, told: str, ended: str, question: str, value: str
) -> None:
    with agent(file) as sim:
        sim.say("my name is ada")
        sim.say(told)
        assert meant(answers(sim, ended), "struck")
        assert value not in answers(sim, question).lower()


def test_a_second_hobby_is_added_and_a_correction_replaces_only_the_last_one(file: Path, look: Look) -> None:
    with agent(file) as sim:
        sim.say("my name is ada")
        sim.say("my hobby is chess")
        sim.say("my hobby is judo")
        assert meant(answers(sim, "no, ludo"), "corrected")
        assert meant(answers(sim, "my hobby is chess"), "known_already")
    assert look() == {"Ada": {"has_hobby": ["chess", "ludo"]}}


# ------------------------------------------------------------------------------------ people with similar names


def test_of_two_people_with_the_same_name_the_better_known_one_counts(file: Path) -> None:
    with agent(file) as sim:
        memory = sim.read(ontology.memory)
        assert memory is not None
        memory.create("Person", name="Ada").result(20)
        second = memory.create("Person", name="Ada").result(20)
        memory.relate(second, "lives_in", memory.create("City", name="Ulm").result(20)).result(20)
        memory.create("Person", name="Ada").result(20)
        assert "you live in Ulm" in answers(sim, "i'm called ada")
        assert sim.read(persqa.who) == second


def test_a_friend_who_was_only_mentioned_is_greeted_as_new(file: Path, look: Look) -> None:
    with agent(file) as sim:
        sim.say("my name is ada")
        sim.say("my friends are called tom and anna")
    with agent(file) as sim:
        assert meant(answers(sim, "my name is tom"), "learned_name")
        sim.say("i live in ulm")
    assert look() == {"Ada": {"friend_of": ["Tom", "Anna"]}, "Tom": {"lives_in": ["Ulm"]}, "Anna": {}}


def test_a_friend_with_the_users_name_is_another_person(file: Path, look: Look) -> None:
    with agent(file) as sim:
        sim.say("my name is ada")
        sim.say("my friend is called ada")
        memory, who = sim.read(ontology.memory), sim.read(persqa.who)
        assert memory is not None and who is not None
        [friend] = memory.related(who, "friend_of").result(20)
        assert friend.id != who.id


@pytest.mark.parametrize(
    ("text", "name"),
    [
        ("my name is 🦊", "🦊"),
        ("my name is ada 🎉", "Ada"),
        ("👋 my name is 🦊 ada👍🏽❤️!", "Ada"),
        ('my name is "; DROP', None),
        ("my name is Robert'); MATCH (n) DETACH DELETE n;--", "Robert"),
        ("my name is o'brien", "O'Brien"),
        ("my name is `}) x", None),
        ("my name is مريم", "مريم"),
        ("my name is {name}", None),
        ("my name is ada\x00\x1b[31m", "Ada"),
    ],
)
def test_unusual_names_are_learned_or_ignored_without_a_failure(
    file: Path, look: Look, text: str, name: str | None
) -> None:
    with agent(file) as sim:
        sim.say("my friend is called kim")
        said = answers(sim, text)
        assert sim.failures == []
        if name is not None:
            assert meant(said, "learned_name")
            assert answers(sim, "i live in ulm") != "I see."
    people = look()
    if name is not None:
        assert people == {name: {"lives_in": ["Ulm"], "friend_of": ["Kim"]}, "Kim": {}}
    else:
        assert people == {} or "Kim" in people


@pytest.mark.parametrize("text", ["ada " * 25_000, "a" * 100_000, "my name is " + "x" * 100_000])
def test_a_text_of_100_kb_causes_no_failure(file: Path, look: Look, text: str) -> None:
    with agent(file) as sim:
        assert asked(sim) == "name"
        assert answers(sim, text) == "I see."
        assert meant(answers(sim, "ada"), "learned_name")
        assert sim.failures == []
    assert look() == {"Ada": {}}


# ------------------------------------------------------------------------------------ questions about the user


def test_the_users_questions_about_themselves_are_answered(file: Path) -> None:
    with agent(file, knower()) as sim:
        assert meant(answers(sim, "do you know my name?"), "recall_stranger")
        assert meant(answers(sim, "ada"), "learned_name")
        assert meant(answers(sim, "do you remember me"), "recall_name")
        assert meant(answers(sim, "where do i live?"), "recall_unknown")
        assert meant(answers(sim, "in ulm"), "learned_home")
        assert answers(sim, "do i live in ulm").endswith("you live in Ulm.")
        assert meant(said := answers(sim, "do i live in bremen?"), "deny") and "Ulm" in said
        sim.say("i work as an engineer at bosch")
        said = answers(sim, "what do you know about me")
        assert said.endswith("your name is Ada, you live in Ulm, you are an engineer and you work for Bosch.")
        assert answers(sim, "where is the station?") == "I know it."
        assert answers(sim, "where can i buy bread?") == "I know it."


def test_the_agent_says_that_it_knows_nothing_about_a_new_user(file: Path) -> None:
    with agent(file) as sim:
        assert meant(answers(sim, "what do you know about me?"), "recall_nothing")


# ------------------------------------------------------------------------------------ forgetting


def test_after_forget_me_and_a_yes_the_agent_forgets_the_user(file: Path, look: Look) -> None:
    with agent(file) as sim:
        sim.put(interloc.users, {"console": None})
        sim.say("my name is ada and i live in hannover")
        assert meant(answers(sim, "please forget me"), "forget_ask")
        assert meant(answers(sim, "no"), "forget_not")
        assert sim.read(persqa.who) is not None
        assert meant(answers(sim, "can you forget me?"), "forget_ask")
        assert meant(answers(sim, "yes"), "forgotten")
        assert sim.read(persqa.who) is None and dict(sim.read(persqa.facts)) == {}
        before = len(sim.said)
        sim.advance(300.0)
        assert len(sim.said) == before
        assert meant(answers(sim, "what is my name?"), "recall_stranger")
        assert dict(sim.read(interloc.users)) == {"console": None}
    assert look() == {}


def test_a_yes_to_a_later_question_does_not_make_the_agent_forget_the_user(file: Path, look: Look) -> None:
    with agent(file, knower()) as sim:
        sim.say("my name is ada")
        assert meant(answers(sim, "forget me"), "forget_ask")
        assert answers(sim, "what time is it?") == "I know it."
        assert answers(sim, "yes") == "I see."
    assert look() == {"Ada": {}}


# ------------------------------------------------------------------------------------ without memory


class Broken:
    """Memory that opens, and fails later."""

    async def opened(self) -> None:
        """Raise no error yet."""

    def __getattr__(self, name: str) -> Any:
        async def fail(*_: object, **__: object) -> None:
            raise PlatformError("the disk is full")

        return fail


def test_without_memory_the_agent_does_not_claim_to_have_forgotten_the_user() -> None:
    with agent(None) as sim:
        sim.say("my name is ada")
        sim.say("forget me")
        assert meant(answers(sim, "yes"), "forget_failed")


def test_without_memory_the_conversation_goes_on_and_the_user_hears_of_it_once() -> None:
    with agent(None) as sim:
        assert sim.read(ontology.memory) is None
        assert meant(answers(sim, "my name is ada"), "unsaved_name")
        assert meant(answers(sim, "i live in ulm"), "learned_home")
        assert answers(sim, "where do i live").endswith("you live in Ulm.")
        assert meant(answers(sim, "no, my name is bob"), "renamed")
        assert sim.failures == []  # missing memory makes no rule fail


def test_a_memory_that_cannot_be_opened_is_not_reported_again(caplog: pytest.LogCaptureFixture) -> None:
    """`ontology` has already reported that the memory cannot be opened."""

    class Unopened(Broken):
        async def opened(self) -> None:
            raise PlatformError("the disk is full")

    with agent(None) as sim:
        sim.put(ontology.memory, Unopened())  # pyright: ignore[reportArgumentType]
        assert meant(answers(sim, "my name is ada"), "unsaved_name")
    assert "ravestate.persqa.listen" not in {record.name for record in caplog.records}


def test_facts_that_could_not_be_saved_are_saved_later(
    file: Path, look: Look, caplog: pytest.LogCaptureFixture
) -> None:
    with agent(file) as sim:
        memory = sim.read(ontology.memory)
        sim.put(ontology.memory, Broken())  # pyright: ignore[reportArgumentType]
        assert meant(answers(sim, "my name is ada"), "unsaved_name")
        assert meant(answers(sim, "i live in ulm"), "learned_home")
        assert [record.getMessage() for record in caplog.records if record.name == "ravestate.persqa.listen"] == [
            "the disk is full"
        ]
        assert meant(answers(sim, "forget me"), "forget_ask")
        assert meant(answers(sim, "yes"), "forget_failed")
        assert sim.read(persqa.who) is not None
        sim.put(ontology.memory, memory)
        assert meant(answers(sim, "i work as a baker"), "learned_occupation")
        assert sim.failures == []
    assert look() == {"Ada": {"lives_in": ["Ulm"], "works_as": ["baker"]}}


def test_a_user_is_recognised_after_memory_works_again(file: Path, look: Look) -> None:
    with agent(file) as sim:
        sim.say("my name is ada and i live in ulm")
    with agent(file) as sim:
        memory = sim.read(ontology.memory)
        sim.put(ontology.memory, Broken())  # pyright: ignore[reportArgumentType]
        sim.say("my name is ada")
        sim.put(ontology.memory, memory)
        sim.say("my hobby is chess")
        assert answers(sim, "where do i live").endswith("you live in Ulm.")
    assert look() == {"Ada": {"lives_in": ["Ulm"], "has_hobby": ["chess"]}}


def test_the_conversation_goes_on_while_another_process_has_the_memory_open(file: Path, look: Look) -> None:
    code = """
import sys
from ravestate.modules import ontology
from ravestate.modules.meta.ontology.opening import open_memory
memory = open_memory(ontology.Settings(path=sys.argv[1]))
memory.opened().result(20)
print("open", flush=True)
sys.stdin.read()
memory.close().result(20)
"""
    command = [sys.executable, "-c", code, str(file)]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as other:
        assert other.stdin is not None and other.stdout is not None
        assert other.stdout.readline() == "open\n"
        with agent(file) as sim:
            assert meant(answers(sim, "my name is ada"), "unsaved_name")
            assert meant(answers(sim, "i live in ulm"), "learned_home")
            assert answers(sim, "where do i live").endswith("you live in Ulm.")
        other.stdin.close()
    assert look() == {}


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no limit on the size of files")
def test_the_conversation_goes_on_with_a_full_disk(file: Path, look: Look) -> None:
    code = """
import os, resource, sys
from ravestate.modules import ontology, persqa
from ravestate.testing import simulate
with simulate(persqa, settings={"ontology": {"path": sys.argv[1]}}) as sim:
    sim.say("my name is ada and i live in ulm")
    resource.setrlimit(resource.RLIMIT_FSIZE, (os.path.getsize(sys.argv[1] + ".wal"), resource.RLIM_INFINITY))
    sim.say("i work as a baker")
    sim.say("where do i live")
    resource.setrlimit(resource.RLIMIT_FSIZE, (resource.RLIM_INFINITY, resource.RLIM_INFINITY))
    sim.say("my hobby is chess")
    print("\\n".join(sim.said))
    assert not sim.failures, sim.failures
"""
    done = subprocess.run([sys.executable, "-c", code, str(file)], capture_output=True, text=True, check=True)
    _, told, recalled, _ = done.stdout.splitlines()
    assert meant(told, "unsaved") and recalled.endswith("you live in Ulm.")
    assert "Traceback" not in done.stderr
    assert look() == {"Ada": {"lives_in": ["Ulm"], "works_as": ["baker"], "has_hobby": ["chess"]}}


def test_a_known_user_is_recognised_even_if_nothing_can_be_saved(
    file: Path, look: Look, caplog: pytest.LogCaptureFixture
) -> None:
    with agent(file) as sim:
        sim.say("my name is ada and i live in ulm")
    with agent(file) as sim:
        sim.read(ontology.memory).opened().result(20)  # pyright: ignore[reportOptionalMemberAccess]
        in_the_way = file.with_name(f"{file.name}.wal")
        in_the_way.mkdir()
        assert meant(answers(sim, "my name is ada"), "unsaved_name")
        assert answers(sim, "where do i live").endswith("you live in Ulm.")
        assert "cannot be opened (Is a directory): name another file" in caplog.text
        in_the_way.rmdir()
        sim.say("i work as a baker")
    assert look() == {"Ada": {"lives_in": ["Ulm"], "works_as": ["baker"]}}


def test_without_nlp_other_modules_answer(file: Path) -> None:
    with simulate(
        persqa,
        chatter(),
        settings={"ontology": {"path": file}, "nlp": {"pipeline": "nonsense"}, "idle": {"bored_after": 5.0}},
    ) as sim:
        assert asked(sim) == "name"
        assert answers(sim, "ada") == "I see."
        assert [rule for rule, _ in sim.failures] == ["nlp:understand"]


# ------------------------------------------------------------------------------------ users who come and go


def test_the_agent_says_what_it_remembers_if_the_platform_gives_the_users_name(file: Path) -> None:
    with agent(file) as sim:
        sim.say("my name is ada and i live in ulm")
    with agent(file) as sim:
        sim.put(interloc.users, {"console": "Ada"})
        sim.advance(6.0)
        assert meant(sim.said[-1], "remind") and "you live in Ulm" in sim.said[-1]
        assert asked(sim) == "origin"
        assert answers(sim, "peru") != "I see."


def test_a_user_without_a_name_gets_one_and_the_next_user_is_another_person(file: Path) -> None:
    with agent(file) as sim:
        sim.put(interloc.users, {"console": None})
        sim.say("my name is ada")
        assert dict(sim.read(interloc.users)) == {"console": "Ada"}
        sim.say("no, my name is bob")
        assert dict(sim.read(interloc.users)) == {"console": "Bob"}
        sim.put(interloc.users, {})
        assert sim.read(persqa.who) is None and dict(sim.read(persqa.facts)) == {}
        before = len(sim.said)
        sim.advance(60.0)
        assert len(sim.said) == before  # nobody is there
        sim.put(interloc.users, {"console": None})
        assert asked(sim) == "name"


def test_the_user_who_stays_keeps_their_own_facts(file: Path, look: Look) -> None:
    with agent(file) as sim:
        sim.put(interloc.users, {"1": "Ada"})
        sim.say("i live in ulm")
        sim.put(interloc.users, {"1": "Ada", "2": "Bob", "3": "Eve"})
        sim.put(interloc.users, {"1": "Ada", "2": "Bob"})
        assert answers(sim, "who am i?").find("Ada") >= 0
        sim.put(interloc.users, {"2": "Bob"})
        assert answers(sim, "who am i?").find("Bob") >= 0
        sim.say("i live in bremen")
    assert look() == {"Ada": {"lives_in": ["Ulm"]}, "Bob": {"lives_in": ["Bremen"]}}


def test_the_user_is_another_person_if_the_platform_gives_another_name(file: Path, look: Look) -> None:
    with agent(file) as sim:
        sim.say("my name is ada and i live in ulm")
        sim.put(interloc.users, {"console": "Bob"})
        assert sim.read(persqa.who)["name"] == "Bob"  # pyright: ignore[reportOptionalSubscript]
        sim.say("i work as a baker")
    assert look() == {"Ada": {"lives_in": ["Ulm"]}, "Bob": {"works_as": ["baker"]}}


def test_a_platform_can_give_a_user_as_a_node_in_memory(file: Path) -> None:
    with agent(file) as sim:
        memory = sim.read(ontology.memory)
        assert memory is not None
        second = [memory.create("Person", name="Ada").result(20) for _ in range(2)][1]
        sim.put(interloc.users, {"camera": second})
        assert sim.read(persqa.who) == second


# ------------------------------------------------------------------------------------ the module


def test_an_unknown_topic_in_the_settings_is_refused() -> None:
    with pytest.raises(rs.DeclarationErrors) as refused:
        simulate(persqa, settings={"persqa": {"topics": ["hobbies"]}})
    assert "there is no topic 'hobbies'" in str(refused.value.exceptions[0])


def test_an_answer_of_persqa_has_a_higher_utility_than_greetings_and_small_talk() -> None:
    policy = rs.compile(persqa, hibye, chatter(), knower())
    mine = policy.utility("persqa:respond")
    for other in ("hibye:answer_hello", "hibye:answer_goodbye", "chatter:chat", "knower:answer"):
        assert mine > policy.utility(other)


def test_importing_the_module_imports_no_heavy_library() -> None:
    code = "import sys; from ravestate.modules import persqa; persqa.module; print('spacy' in sys.modules, 'ladybug' in sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "False False\n"


@pytest.mark.parametrize("text", ["nobody rang today either...", "I'm afraid of her face when I say it."])
def test_sorrow_is_not_taken_for_a_refusal(file: Path, text: str) -> None:
    with agent(file) as sim:
        assert asked(sim) == "name"
        assert answers(sim, text) == "I see."


def test_another_persons_girlfriend_is_not_taken_for_the_users_partner(file: Path) -> None:
    with agent(file) as sim:
        sim.say("my ex Ralf came by and hes got a new girlfriend called Tamara")
        assert dict(sim.read(persqa.facts)) == {}


def test_an_age_in_words_is_understood(file: Path) -> None:
    with agent(file) as sim:
        sim.say("im seven and a half")
        assert dict(sim.read(persqa.facts)) == {"age": ("7",)}


def test_other_modules_answer_sorrow_about_a_relative(file: Path) -> None:
    with agent(file) as sim:
        assert answers(sim, "my son Fiete has a bad fever") == "I see."
        assert dict(sim.read(persqa.facts)) == {"son": ("Fiete",)}


def test_in_the_first_turns_the_agent_asks_only_for_the_name_and_after_sad_news_for_nothing(file: Path) -> None:
    with agent(file, turns=3) as sim:
        assert asked(sim) == "name"
        sim.say("it is raining")
        sim.say("my name is ada")
        sim.advance(60.0)
        assert sim.said[-1] != "" and sim.read(persqa.talk).question is None
        sim.say("my dog died yesterday")
        sim.advance(60.0)
        assert sim.read(persqa.talk).question is None
