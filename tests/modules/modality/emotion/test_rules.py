"""The rules of `emotion`: words raise feelings, and an emoji shows a feeling once, after the answer of any rule."""

import asyncio
from collections import Counter, deque
from collections.abc import AsyncGenerator, Sequence
from contextlib import suppress
from typing import Any

import pytest

import ravestate as rs
from ravestate.errors import DeclarationErrors
from ravestate.modules import conio, emotion, fillers, hibye, idle, interloc, rawio, wildtalk
from ravestate.modules.modality.emotion.feeling import EMOJI
from ravestate.modules.platform.conio.console import Console
from ravestate.testing import Simulation, simulate

ALL = [sign for signs in EMOJI.values() for sign in signs]
CALM: dict[str, Any] = {"shy": 0.0, "surprised": 0.0, "happy": 0.0, "affectionate": 0.0}


def module(name: str = "skill", seconds: float = 0.0, **declared: Any) -> rs.Module:
    """Return a skill that answers every input with "Yes." after some seconds."""
    skill = rs.Module(name, requires=[rawio, emotion])

    @skill.rule(when=rawio.input.changed, writes=rawio.output, **declared)
    async def answer(ctx: rs.RuleContext) -> None:
        if seconds:
            await ctx.sleep(seconds)
        ctx[rawio.output] = "Yes."

    return skill


def calm(*modules: Any, **settings: Any) -> Simulation:
    # The gate for generated replies would refuse the pieces of `Model`, because they are no sentences.
    more = {"wildtalk": {"gate": False}} if wildtalk in modules else {}
    return simulate(emotion, *modules, settings={"emotion": {**CALM, **settings}, **more})


def felt(sim: Simulation) -> list[str]:
    return [name.removeprefix("emotion:feel_") for name in sim.fired if name.startswith("emotion:feel_")]


@pytest.mark.parametrize(
    ("text", "feeling"),
    [
        ("You are so clever!", "shy"),
        ("I love you.", "affectionate"),
        ("I passed my exam!", "happy"),
        ("Wow!", "surprised"),
    ],
)
def test_the_users_words_raise_a_feeling(text: str, feeling: str) -> None:
    with calm() as sim:
        sim.say(text)
        assert felt(sim) == [feeling]
        assert sim.read(emotion.felt) == feeling


@pytest.mark.parametrize("text", ["The train leaves at nine.", "You are not nice.", "", "How old are you?"])
def test_neutral_words_raise_no_feeling(text: str) -> None:
    with calm() as sim:
        sim.say(text)
        assert (felt(sim), sim.said) == ([], [])


@pytest.mark.parametrize(
    ("text", "feeling"),
    [
        ("What are you up to today", "shy"),
        ("When does the train leave?", "surprised"),
        ("Hello", "happy"),
        ("Good night!", "affectionate"),
    ],
)
def test_some_inputs_raise_a_feeling_with_the_probability_in_the_settings(text: str, feeling: str) -> None:
    with calm(**{feeling: 1.0}) as sim:
        sim.say(text)
        assert felt(sim) == [feeling]
    with calm() as sim:
        sim.say(text)
        assert felt(sim) == []


def test_feelings_are_as_frequent_as_the_setting_says_and_equal_seeds_give_equal_results() -> None:
    def showed_feeling(seed: int) -> list[bool]:
        with simulate(emotion, settings={"emotion": {**CALM, "shy": 0.3}}, seed=seed) as sim:
            found: list[bool] = []
            for _ in range(200):
                before = len(felt(sim))
                sim.say("What are you up to today")
                found.append(len(felt(sim)) > before)
            return found

    first = showed_feeling(1)
    assert 40 <= sum(first) <= 80
    assert first == showed_feeling(1)
    assert first != showed_feeling(2)


def test_a_probability_above_1_is_refused() -> None:
    with pytest.raises(DeclarationErrors) as caught:
        simulate(emotion, settings={"emotion": {"shy": 1.5}})
    assert "emotion.shy = 1.5" in str(caught.value.exceptions[0])


@pytest.mark.parametrize("seconds", [0.0, 3.0])
def test_the_emoji_follows_the_answer(seconds: float) -> None:
    with calm(module(seconds=seconds)) as sim:
        sim.say("You are so clever!")
        sim.advance(10.0)
        assert sim.said[0] == "Yes."
        assert len(sim.said) == 2
        assert sim.said[1] in EMOJI["shy"]


def test_without_an_answer_the_emoji_is_the_only_utterance() -> None:
    with calm() as sim:
        sim.say("You are so clever!")
        assert len(sim.said) == 1
        assert sim.said[0] in EMOJI["shy"]


def test_a_setting_turns_the_emoji_off() -> None:
    with calm(module(), emoji=False) as sim:
        sim.say("You are so clever!")
        assert sim.said == ["Yes."]
        assert sim.read(emotion.felt) == "shy"


def test_any_rule_can_raise_a_feeling_before_or_after_it_speaks() -> None:
    glad = rs.Module("glad", requires=[rawio, emotion])

    @glad.rule(when=rawio.input.changed, writes=rawio.output, emits=emotion.happy)
    async def answer(ctx: rs.RuleContext) -> None:
        if "late" not in ctx.payload(rawio.input.changed):
            ctx.emit(emotion.happy)
        ctx[rawio.output] = "Yes."
        if "late" in ctx.payload(rawio.input.changed):
            ctx.emit(emotion.happy)

    for text in ("at once", "late"):
        with calm(glad) as sim:
            sim.say(text)
            assert sim.said[0] == "Yes."
            assert len(sim.said) == 2
            assert sim.said[1] in EMOJI["happy"]


def test_only_the_latest_feeling_is_shown_as_an_emoji() -> None:
    glad = rs.Module("glad", requires=[rawio, emotion])

    @glad.rule(when=rawio.input.changed, writes=rawio.output, emits=(emotion.happy, emotion.affectionate))
    async def answer(ctx: rs.RuleContext) -> None:
        ctx.emit(emotion.happy)
        await ctx.sleep(1.0)
        ctx[rawio.output] = "Yes."
        ctx.emit(emotion.affectionate)

    with calm(glad) as sim:
        sim.say("You are so clever!")
        sim.advance(10.0)
        assert Counter(felt(sim)) == {"shy": 1, "happy": 1, "affectionate": 1}
        assert sim.said[0] == "Yes."
        assert len(sim.said) == 2
        assert sim.said[1] in EMOJI["affectionate"]


def test_simultaneous_feelings_are_shown_as_one_emoji() -> None:
    glad = rs.Module("glad", requires=[rawio, emotion])
    bell = glad.signal("bell")

    @glad.rule(when=bell, emits=(emotion.happy, emotion.shy, emotion.surprised))
    async def ring(ctx: rs.RuleContext) -> None:
        ctx.emit(emotion.happy)
        ctx.emit(emotion.shy)
        ctx.emit(emotion.surprised)

    with calm(glad) as sim:
        sim.emit(bell)
        assert len(sim.said) == 1
        assert sim.said[0] in ALL


def test_a_rule_that_reacts_to_a_feeling_answers_instead_of_small_talk() -> None:
    kind = rs.Module("kind", requires=[rawio, emotion])

    @kind.rule(when=emotion.happy, writes=rawio.output)
    async def be_glad(ctx: rs.RuleContext) -> None:
        ctx[rawio.output] = "I am glad for you!"

    with calm(module(), kind) as sim:
        sim.say("I passed my exam!")
        assert sim.said[0] == "I am glad for you!"
        assert sim.said[1] in EMOJI["happy"]
        sim.say("The train leaves at nine.")
        assert sim.said[2:] == ["Yes."]


def test_no_emoji_appears_if_the_user_speaks_before_the_answer_ends() -> None:
    with calm(module(seconds=3.0)) as sim:
        sim.say("You are so clever!")
        sim.advance(1.0)
        sim.say("The train leaves at nine.")
        sim.advance(10.0)
        assert sim.said == ["Yes.", "Yes."]


def test_each_feeling_is_shown_after_its_own_answer() -> None:
    with calm(module()) as sim:
        for _ in range(3):
            sim.say("You are so clever!")
            sim.advance(1.0)
        assert [text in EMOJI["shy"] for text in sim.said] == [False, True] * 3


def test_the_emoji_waits_for_the_answer_and_not_for_a_filler() -> None:
    with calm(module(seconds=4.0), more_specific(), fillers) as sim:
        sim.say("You are so clever!")
        sim.advance(10.0)
        assert len(sim.said) == 3
        assert sim.said[1] == "Yes."
        assert sim.said[2] in EMOJI["shy"]


def more_specific() -> rs.Module:
    """Return a skill that makes other rules wait for 3 s, and then resigns."""
    slow = rs.Module("slow", requires=[rawio])

    @slow.rule(when=rawio.input.changed.where(bool), writes=rawio.output)
    async def think(ctx: rs.RuleContext) -> rs.Resign:
        await ctx.sleep(3.0)
        return rs.Resign("nothing comes to mind")

    return slow


def test_the_emoji_follows_the_greeting_of_hibye() -> None:
    with calm(hibye, happy=1.0) as sim:
        sim.say("Hello!")
        assert len(sim.said) == 2
        assert sim.said[0] not in ALL
        assert sim.said[1] in EMOJI["happy"]


def test_the_agent_is_not_cheerful_after_sad_words() -> None:
    with calm(happy=1.0, surprised=1.0) as sim:
        sim.say("My father died last week.")
        for text in ("He made me laugh so often, and that was wonderful!", "Wow!", "Thanks.", "Why is that so?"):
            sim.say(text)
        assert not {"happy", "surprised"} & set(felt(sim))
        for _ in range(9):
            sim.say("The table has four legs.")
        sim.say("I passed my exam!")
        assert felt(sim)[-1] == "happy"


def test_sorrow_lasts_for_the_next_eleven_utterances() -> None:
    with calm(happy=1.0) as sim:
        sim.say("My father died last week.")
        for _ in range(11):
            sim.say("I passed my exam!")
        assert felt(sim) == ["sad"]
        sim.say("I passed my exam!")
        assert felt(sim)[-1] == "happy"


@pytest.mark.parametrize("text", ["What is that to you?", "When does the train leave?", "What is 7 percent of 1300?"])
def test_plain_questions_do_not_surprise_the_agent(text: str) -> None:
    with simulate(emotion, seed=1) as sim:
        for _ in range(20):
            sim.say(text)
        assert "surprised" not in felt(sim)


def test_an_emoji_does_not_delay_the_signal_bored() -> None:
    bored = rs.Module("lonely", requires=[rawio, idle])

    @bored.rule(when=idle.bored, writes=rawio.output)
    async def ask(ctx: rs.RuleContext) -> None:
        ctx[rawio.output] = f"bored at {ctx.now:g} s"

    with simulate(emotion, bored, module(), settings={"emotion": CALM}) as sim:
        sim.say("You are so clever!")
        sim.advance(15.0)
        assert sim.said[2:] == ["bored at 15 s"]
        sim.advance(3.0)
        assert [a for a in sim.snapshot()["activations"] if "emotion" in str(a)] == []


def test_each_context_has_its_own_feelings() -> None:
    policy = rs.compile(emotion)
    with simulate(policy) as one, simulate(policy) as other:
        one.say("I love you.")
        assert one.read(emotion.felt) == "affectionate"
        assert other.read(emotion.felt) is None


# ------------------------------------------------------------------------------- with wildtalk, on the console


class Model:
    """A language model that yields three pieces, one per second."""

    async def load(self, progress: object = None) -> None: ...

    async def stream(self, messages: Sequence[Any], **options: Any) -> AsyncGenerator[str, None]:
        for piece in ("Thank", " you, Ada", "!"):
            yield piece
            with suppress(TimeoutError):
                await asyncio.wait_for(asyncio.Event().wait(), 1.0)

    async def close(self) -> None: ...


class Screen:
    """A screen for which a test types lines. It keeps the output in `lines`."""

    interactive = True

    def __init__(self) -> None:
        self.typed: deque[str] = deque()
        self.more = asyncio.Event()
        self.lines = ""

    def type(self, line: str) -> None:
        self.typed.append(line)
        self.more.set()

    async def __aenter__(self) -> object:
        return self

    async def __aexit__(self, *_: object) -> None: ...

    async def read(self) -> str:
        while not self.typed:
            self.more.clear()
            await self.more.wait()
        return self.typed.popleft()

    def show(self, text: str) -> None:
        self.lines += text + "\n"

    def stream(self, piece: str) -> None:
        self.lines += piece

    def end(self) -> None:
        self.lines += "\n"


def test_on_the_console_the_emoji_follows_a_streamed_answer(monkeypatch: pytest.MonkeyPatch) -> None:
    screen = Screen()
    monkeypatch.setattr(conio.rules, "Console", lambda **_: Console(screen))
    with calm(conio, interloc, wildtalk) as sim:
        sim.put(wildtalk.model, Model())
        screen.type("You are so clever!")
        sim.settle()
        assert screen.lines == "Thank"
        sim.advance(1.5)
        assert screen.lines == "Thank you, Ada"
        sim.advance(15.0)
        answer, emoji = screen.lines.splitlines()
        assert answer == "Thank you, Ada!"
        assert emoji in EMOJI["shy"]
    assert not sim.failures


def test_an_answer_that_is_interrupted_gets_no_emoji(monkeypatch: pytest.MonkeyPatch) -> None:
    screen = Screen()
    monkeypatch.setattr(conio.rules, "Console", lambda **_: Console(screen))
    with calm(conio, interloc, wildtalk) as sim:
        sim.put(wildtalk.model, Model())
        screen.type("You are so clever!")
        sim.advance(1.5)
        screen.type("The train leaves at nine.")
        sim.advance(10.0)
        assert [text for text in sim.said if text in ALL] == []
        assert sim.said[-1] == "Thank you, Ada!"


def test_with_pipes_each_line_gets_its_answer_and_its_emoji(monkeypatch: pytest.MonkeyPatch) -> None:
    screen = Screen()
    screen.interactive = False
    monkeypatch.setattr(conio.rules, "Console", lambda **_: Console(screen))
    with calm(conio, interloc, module(seconds=1.0)) as sim:
        screen.type("You are so clever!")
        screen.type("I love you.")
        sim.advance(10.0)
        assert len(sim.said) == 4
        assert [sim.said[0], sim.said[2]] == ["Yes.", "Yes."]
        assert sim.said[1] in EMOJI["shy"]
        assert sim.said[3] in EMOJI["affectionate"]
