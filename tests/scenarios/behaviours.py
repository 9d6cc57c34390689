"""Ten behaviours of an agent, which run both on the bare engine and on the runtime.

The argument `play` of each function is `Driver` for the bare engine, or `simulate` for the runtime.
"""

from __future__ import annotations

import gc
from collections.abc import Callable
from typing import Any

import ravestate as rs
from ravestate.engine.activation import Activation
from ravestate.engine.events import Write
from ravestate.engine.group import Group
from ravestate.engine.spike import Spike
from ravestate.engine.trace import Settled, Started
from ravestate.modules import rawio
from scenarios.driver import Driver

Play = Callable[..., Any]


def talker(m: rs.Module, name: str, when: rs.Condition, *, hears: bool = True, **options: Any) -> None:
    """Declare a rule that says its own name and, if `hears`, also the user's input."""

    @m.rule(when=when, writes=rawio.output, name=name, **options)
    async def talk(ctx: Any) -> None:
        ctx[rawio.output] = f"{name}: {ctx.payload(rawio.input.changed)}" if hears else name


def classifier(
    m: rs.Module, signal: rs.Signal[str], word: str, *, takes: Callable[[str], float] = lambda text: 0.0
) -> None:
    """Declare a rule that raises a signal if the input contains `word`. The rule runs for `takes(input)` seconds."""

    @m.rule(when=rawio.input.changed, emits=signal, name=f"Find{signal.name.split(':')[1].title()}")
    async def classify(ctx: Any) -> None:
        text = ctx.payload(rawio.input.changed)
        if takes(text):
            await ctx.sleep(takes(text))
        if word in text:
            ctx.emit(signal, text)


def dialogue(takes: float = 0.0) -> tuple[rs.Module, rs.Signal[str]]:
    """Declare the rules `FindQuestion`, `Qa` and `Wildtalk`."""
    m = rs.Module("m", requires=[rawio])
    question = m.signal("question", payload=str)
    classifier(m, question, "?", takes=lambda text: takes)
    talker(m, "Qa", question & rawio.input.changed)
    talker(m, "Wildtalk", rawio.input.changed)
    return m, question


def runs_of(sim: Any, rule: str) -> list[float]:
    """Return the times at which a rule began to run (seconds)."""
    return [round(r.time, 6) for r in sim.trace if isinstance(r, Started) and r.rule == f"m:{rule}"]


def question(play: Play) -> None:
    """1. "How are you?" raises `question` and `about_agent`; only their conjunction answers."""
    m = rs.Module("m", requires=[rawio])
    question, about_agent = m.signal("question", payload=str), m.signal("about_agent", payload=str)
    classifier(m, question, "?")
    classifier(m, about_agent, "you")
    talker(m, "Wildtalk", rawio.input.changed)
    talker(m, "Qa", question, hears=False)
    talker(m, "Shy", about_agent, hears=False)
    talker(m, "PersonalQa", question & about_agent, hears=False)
    with play(m) as sim:
        sim.say("How are you?")
        assert sim.said == ["PersonalQa"]
        sim.say("What time is it?")
        assert sim.said == ["PersonalQa", "Qa"]
        sim.say("I like you.")
        assert sim.said == ["PersonalQa", "Qa", "Shy"]
        sim.advance(10.0)
        assert sim.said == ["PersonalQa", "Qa", "Shy"]


def wildtalk_waits_only_until_the_classifier_ends(play: Play) -> None:
    """2. `Wildtalk` answers a statement as soon as `FindQuestion` has ended. Only `Qa` answers a question."""
    for takes in (0.0, 0.7):
        m, _ = dialogue(takes)
        with play(m) as sim:
            sim.say("Nice weather.")
            sim.advance(takes)
            assert sim.said == ["Wildtalk: Nice weather."]
            sim.say("Who is there?")
            sim.advance(takes)
            assert sim.said == ["Wildtalk: Nice weather.", "Qa: Who is there?"]
            sim.advance(10.0)
            assert len(sim.said) == 2
            assert runs_of(sim, "Wildtalk") == [takes]
            assert runs_of(sim, "Qa") == [2 * takes]


def qa_resigns(play: Play) -> None:
    """3. If `Qa` resigns, `Wildtalk` answers the same input."""
    m = rs.Module("m", requires=[rawio])
    question = m.signal("question", payload=str)
    classifier(m, question, "?")

    @m.rule(when=question, writes=rawio.output)
    async def Qa(ctx: Any) -> rs.Resign:
        await ctx.sleep(1.5)
        return rs.Resign("no idea")

    talker(m, "Wildtalk", rawio.input.changed)
    with play(m) as sim:
        sim.say("Why?")
        sim.advance(1.5)
        assert sim.said == ["Wildtalk: Why?"]
        assert runs_of(sim, "Wildtalk") == [1.5]
        assert "m:Qa" not in sim.fired
        sim.advance(10.0)
        assert len(sim.said) == 1


def slow_cause(play: Play) -> None:
    """4. While the classifier runs for 2 s, `Wildtalk` waits, `core:pressure` is true, and a filler can speak."""
    m, _ = dialogue(takes=2.0)
    talker(m, "Filler", rs.pressure.true.min_age(0.8), hears=False, background=True)
    for text, answer in (
        ("Nice weather.", "Wildtalk: Nice weather."),
        ("Who is there?", "Qa: Who is there?"),
    ):
        with play(m) as sim:
            assert sim.read(rs.pressure) is False
            sim.say(text)
            for said in ([], ["Filler"]):
                assert sim.read(rs.pressure) is True
                assert sim.said == said
                sim.advance(1.0)
            assert sim.said == ["Filler", answer]
            assert sim.read(rs.pressure) is False
            sim.advance(10.0)
            assert sim.said == ["Filler", answer]


def fusion(play: Play) -> None:
    """5. `Fused` answers if a gesture follows the words after 300 ms.

    Without a gesture, `Speech` answers after the patience.
    """
    for patience, own in ((1.0, None), (2.5, None), (1.0, 0.4)):
        m = rs.Module("m", requires=[rawio])
        point = m.signal("point")
        talker(m, "Fused", point & rawio.input.changed, patience=own)
        talker(m, "Speech", rawio.input.changed)
        waited = patience if own is None else own
        with play(m, patience=patience) as sim:
            sim.say("That one!")
            sim.advance(0.3)
            sim.emit(point)
            assert sim.said == ["Fused: That one!"]
            sim.advance(10.0)
            sim.say("That one.")
            sim.advance(10.0)
            assert sim.said == ["Fused: That one!", "Speech: That one."]
            assert runs_of(sim, "Fused") == [0.3]
            assert runs_of(sim, "Speech") == [round(10.3 + waited, 6)]


def prompt_loop(play: Play) -> None:
    """6. While the user is silent, the agent asks again 10 s plus the patience after each prompt.

    After an answer, only `Answered` fires, and only once.
    """
    m = rs.Module("m", requires=[rawio])
    prompted = m.signal("prompted")

    def prompter(name: str, when: rs.Condition) -> None:
        @m.rule(when=when, writes=rawio.output, emits=prompted, detached=True, name=name)
        async def prompt(ctx: Any) -> None:
            ctx[rawio.output] = name
            ctx.emit(prompted)

    prompter("Prompt", rs.startup)
    prompter("PromptAgain", prompted.min_age(10.0).max_age(None))
    talker(m, "Answered", prompted.max_age(None) & rawio.input.changed)
    with play(m) as sim:
        sim.advance(50.0)
        assert sim.said == ["Prompt"] + ["PromptAgain"] * 4
        assert runs_of(sim, "PromptAgain") == [11.0, 22.0, 33.0, 44.0]
        sim.say("Well...")
        sim.advance(100.0)
        assert sim.said == ["Prompt"] + ["PromptAgain"] * 4 + ["Answered: Well..."]
    for moment in (9.0, 10.5):  # at 10.5 s, the next prompt is ready, but waits with patience
        with play(m) as sim:
            sim.advance(moment)
            sim.say("Fine.")
            assert sim.said == ["Prompt", "Answered: Fine."]
            sim.advance(100.0)
            assert sim.said == ["Prompt", "Answered: Fine."]


def two_inputs_at_once(play: Play) -> None:
    """7. Two simultaneous inputs are two causal groups. Each gets one answer, in the order of the inputs."""
    for takes in (0.0, 0.7):
        m, _ = dialogue(takes)
        for texts in (
            ("One.", "Two."),
            ("One?", "Two."),
            ("One.", "Two?"),
            ("One?", "Two?"),
            ("Same.", "Same."),
        ):
            with play(m) as sim:
                for text in texts:
                    if isinstance(sim, Driver):
                        sim.receive(Write(rawio.input.name, text))
                    else:
                        sim.context.put(rawio.input, text)
                sim.settle()
                sim.advance(10.0)
                assert sim.said == answers(texts)


def answers(texts: tuple[str, ...]) -> list[str]:
    """Return the expected answers, in order: those of `Qa` to questions, and those of `Wildtalk` to other inputs."""
    return [f"{'Qa' if text.endswith('?') else 'Wildtalk'}: {text}" for text in texts]


def burst(play: Play) -> None:
    """8. Each rule handles each of 10,000 spikes within a second exactly once. No engine object stays alive."""
    m = rs.Module("m")
    tick, count = m.signal("tick", payload=int), m.slot("count", 0)
    quick: list[int] = []
    slow: list[int] = []

    @m.rule(when=tick)
    async def Quick(ctx: Any) -> None:
        quick.append(ctx.payload(tick))

    @m.rule(when=tick, writes=count)
    async def Slow(ctx: Any) -> None:
        await ctx.sleep(0.5)
        slow.append(ctx.payload(tick))
        ctx[count] = len(slow)

    with play(m, trace=False) as sim:
        before = live_objects()
        for number in range(10_000):
            sim.emit(tick, number)
            if number % 100 == 99:
                sim.advance(0.01)
        sim.advance(10.0)
        assert quick == sorted(slow) == list(range(10_000))
        assert sim.read(count) == 10_000
        state = sim.snapshot()
        assert (state["spikes"], state["activations"], state["groups"]) == ([], [], [])
        if isinstance(sim, Driver):
            sim.log.clear()
            sim.effects.clear()
        assert live_objects() == before


def live_objects() -> int:
    """Count the spikes, activations and groups that are still in memory."""
    gc.collect()
    # Compare types, because `isinstance` could run an object's own code.
    return sum(type(one) in (Spike, Activation, Group) for one in gc.get_objects())


def independent_writers(play: Play) -> None:
    """9. For the same input, `Emotion`, which writes `face`, runs at the same time as `Qa`, which writes the output."""
    m, question = dialogue()
    face = m.slot("face", "")

    @m.rule(when=question, writes=face)
    async def Emotion(ctx: Any) -> None:
        ctx[face] = "curious"
        await ctx.sleep(3.0)

    with play(m) as sim:
        sim.say("Who is there?")
        assert (sim.said, sim.read(face)) == (["Qa: Who is there?"], "curious")
        assert runs_of(sim, "Emotion") == runs_of(sim, "Qa") == [0.0]
        sim.advance(5.0)
        assert {"m:Emotion", "m:Qa"} <= set(sim.fired)
        assert all(r.outcome == "done" for r in sim.trace if isinstance(r, Settled))


def cooldown(play: Play) -> None:
    """10. Two rules for `bored` take turns, because each has a cooldown. The rule with the greater weight begins."""
    m = rs.Module("m", requires=[rawio])
    bored = m.signal("bored")
    talker(m, "Hum", bored, hears=False, weight=1.0, cooldown=30.0)
    talker(m, "Joke", bored, hears=False, weight=1.2, cooldown=30.0)
    talker(m, "Wildtalk", rawio.input.changed)
    with play(m) as sim:
        for _ in range(6):
            sim.emit(bored)
            sim.advance(10.0)
        assert sim.said == ["Joke", "Hum"] * 3


BEHAVIOURS = [
    question, wildtalk_waits_only_until_the_classifier_ends, qa_resigns, slow_cause, fusion, prompt_loop,
    two_inputs_at_once, burst, independent_writers, cooldown,
]  # fmt: skip
