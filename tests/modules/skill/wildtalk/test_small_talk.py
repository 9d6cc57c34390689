"""The listening skill and the gate in a running agent, in virtual time."""

import threading
from collections.abc import AsyncGenerator, Callable, Iterator, Sequence
from dataclasses import replace
from typing import Any

import pytest

import ravestate as rs
from ravestate.language.chat import Message, Progress
from ravestate.language.matcher import bundled_matcher
from ravestate.modules import interloc, rawio, wildtalk
from ravestate.modules.skill.wildtalk import rules, small_talk
from ravestate.modules.skill.wildtalk.listening import Listener, ListeningBackend, State
from ravestate.modules.skill.wildtalk.listening.state import Game
from ravestate.modules.skill.wildtalk.names import overheard
from ravestate.modules.skill.wildtalk.small_talk import learn_all, listener
from ravestate.testing import Simulation, simulate

other = rs.Module("other", requires=[rawio, interloc])


@other.rule(when=rs.startup, writes=interloc.facts)
async def remember(ctx: rs.RuleContext) -> None:
    ctx[interloc.facts].add("home", ("Hannover",))


@other.rule(when=rawio.input.changed.where(lambda text: "weather" in text), writes=rawio.output, weight=9.0)
async def forecast(ctx: rs.RuleContext) -> None:
    ctx[rawio.output] = "Sunny. Do you like the sun?"


@other.rule(when=rawio.input.changed.where(lambda text: text == "yes"), writes=rawio.output, weight=1.6)
async def confirm(ctx: rs.RuleContext) -> None:
    ctx[rawio.output] = "It is done."


class Scripted:
    """A model that writes prepared answers, and keeps the prompts."""

    def __init__(self, *answers: str) -> None:
        self.answers = list(answers)
        self.prompts: list[Sequence[Message]] = []

    async def load(self, progress: Progress | None = None) -> None:
        """Do nothing, because there is no model to load."""

    async def stream(self, messages: Sequence[Message], **_: Any) -> AsyncGenerator[str, None]:
        self.prompts.append(messages)
        for word in self.answers.pop(0).split(" "):
            yield word + " "

    async def close(self) -> None:
        """Do nothing, because there is no model to close."""


@pytest.fixture(scope="module", autouse=True)
def _models() -> None:
    for name in ("acts", "feelings"):
        bundled_matcher(name).load()
    learn_all()


@pytest.fixture
def sim() -> Iterator[Simulation]:
    with simulate(wildtalk, other, seed=1) as running:
        running.put(wildtalk.model, ListeningBackend())
        yield running
        assert not running.failures


def test_without_a_model_the_listening_skill_answers(sim: Simulation) -> None:
    sim.say("my mother is ill")
    assert len(sim.said) == 1
    assert sim.read(wildtalk.listening).tone == "sad"


def test_slow_checks_do_not_block_the_event_loop(sim: Simulation, monkeypatch: pytest.MonkeyPatch) -> None:
    checked: list[tuple[str, bool]] = []

    def noted(name: str, check: Callable[..., Any]) -> Callable[..., Any]:
        def run(*given: Any, **options: Any) -> Any:
            checked.append((name, threading.current_thread() is loop))
            return check(*given, **options)

        return run

    loop = threading.current_thread()
    monkeypatch.setattr(rules, "claims", noted("claims", rules.claims))
    monkeypatch.setattr(rules, "needs_comfort", noted("needs_comfort", rules.needs_comfort))
    monkeypatch.setattr(Listener, "continues", noted("continues", Listener.continues))
    monkeypatch.setattr(Listener, "knows", noted("knows", Listener.knows))
    for text in ("my dog has died", "tell me a riddle", "no idea", "we saw a heron by the lake"):
        sim.say(text)
    assert {name for name, _ in checked} == {"claims", "needs_comfort", "continues", "knows"}
    assert not any(blocks for _, blocks in checked)


def test_before_the_examples_are_learnt_nothing_looks_at_them_on_the_event_loop(
    sim: Simulation, monkeypatch: pytest.MonkeyPatch
) -> None:
    loop = threading.current_thread()
    callers: list[threading.Thread] = []

    def noted() -> Listener:
        callers.append(threading.current_thread())
        return listener()

    monkeypatch.setattr(small_talk, "learnt", threading.Event())
    monkeypatch.setattr(small_talk, "listener", noted)
    sim.say("my dog has died")
    assert callers
    assert loop not in callers
    assert sim.fired[-1] == "wildtalk:comfort"


def test_small_talk_answers_once_although_two_of_its_clauses_wait_for_the_input(sim: Simulation) -> None:
    for text in ("hello", "hello", "I bought a hat"):
        sim.say(text)
        sim.advance(1.0)
    assert len(sim.said) == 3


def test_other_modules_do_not_answer_a_turn_in_a_game(sim: Simulation) -> None:
    sim.say("word chain")
    word = sim.said[0].rstrip(".").split()[-1]
    assert not sim.read(wildtalk.listening).game.used[1:]
    sim.put(wildtalk.listening, replace(sim.read(wildtalk.listening), game=Game("chain", "bow", ("bow",))))
    sim.say("weather")
    assert word
    assert "Sunny" not in sim.said[-1]
    assert sim.read(wildtalk.listening).game.used[:2] == ("bow", "weather")


def test_other_modules_answer_a_long_remark_during_a_game(sim: Simulation) -> None:
    sim.say("tell me a riddle")
    sim.say("by the way, I would rather hear what the weather is going to be like tomorrow")
    assert sim.said[-1].startswith("Sunny")


def test_a_yes_to_another_modules_question_is_left_to_that_module(sim: Simulation) -> None:
    sim.say("my mother is ill")
    sim.say("how is the weather")
    sim.say("yes")
    assert sim.said[-1] == "It is done."


def test_utterances_that_other_modules_answer_also_set_the_tone(sim: Simulation) -> None:
    sim.say("the weather is awful, my grandfather died yesterday")
    sim.say("he had a white beard")
    assert sim.read(wildtalk.listening).tone == "sad"


def test_the_listening_skill_tells_jokes_even_if_a_model_makes_the_small_talk(sim: Simulation) -> None:
    model = Scripted()
    sim.put(wildtalk.model, model)
    sim.say("tell me a joke")
    assert len(sim.said) == 1
    assert model.prompts == []


@pytest.mark.parametrize(
    "bad",
    [
        "As an AI language model, I have no feelings.",
        "Awwww! See https://example.org for tips.",
        "The best pizza in town is open until nine.",
        "User: my mother is ill",
        "<|junk|>```",
        "My name is Marlene.",
        "I visited my mother yesterday and we had pizza.",
    ],
)
def test_a_bad_answer_is_replaced_by_the_listening_skill(bad: str, sim: Simulation) -> None:
    sim.put(wildtalk.model, Scripted(bad))
    sim.say("my mother is ill")
    (answer,) = sim.said
    assert answer not in bad
    assert sim.read(wildtalk.listening).tone == "sad"


def test_a_good_answer_passes(sim: Simulation) -> None:
    sim.put(wildtalk.model, Scripted("I am sorry to hear that. I hope she gets well soon."))
    sim.say("my mother is ill")
    assert sim.said == ["I am sorry to hear that. I hope she gets well soon."]


def test_a_bad_sentence_after_a_good_one_is_left_out(sim: Simulation) -> None:
    sim.put(wildtalk.model, Scripted("I am sorry to hear that. Visit www.example.org now!"))
    sim.say("my mother is ill")
    assert sim.said == ["I am sorry to hear that."]


def test_a_claim_that_contradicts_a_known_fact_is_refused(sim: Simulation) -> None:
    sim.put(wildtalk.model, Scripted("You live in Berlin."))
    sim.say("guess where my home is these days")
    assert "Berlin" not in sim.said[0]


def test_the_prompt_contains_the_known_facts_about_the_user(sim: Simulation) -> None:
    model = Scripted("That sounds nice.")
    sim.put(wildtalk.model, model)
    sim.say("I like the sea")
    system = model.prompts[0][0].text
    assert system.startswith("You are Ravestate")
    assert "home: Hannover" in system
    assert "It is " in system


def test_forgetting_the_user_deletes_the_conversation(sim: Simulation) -> None:
    sim.say("my mother is ill")
    sim.advance(1.0)
    sim.emit(interloc.forgotten)
    sim.advance(1.0)
    assert not sim.read(wildtalk.history)
    assert sim.read(wildtalk.listening) == State()
    assert sim.read(overheard) == ()
