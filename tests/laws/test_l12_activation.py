"""L12: an activation is a clause and the spikes that it has acquired.

One activation of each rule always stands by. Several can hold the same spike. The spikes of an activation cohere.
"""

from typing import Any

import pytest

import ravestate as rs
from laws.short import at_rest, emitter, hearer, moments, output, started, writer, written


def test_a_signal_that_arrives_while_the_rule_runs_starts_another_run(play: Any) -> None:
    m = rs.Module("m")
    a, out = m.signal("a"), output(m)
    writer(m, "slow", a, out, after=10.0)
    with play(m) as sim:
        for _ in range(3):
            sim.emit(a)
            sim.advance(1.0)
        assert started(sim) == [(0.0, "slow"), (1.0, "slow"), (2.0, "slow")]
        sim.advance(20.0)
        assert moments(sim, out) == [(10.0, "slow"), (11.0, "slow"), (12.0, "slow")]


def test_while_one_activation_lacks_a_spike_a_second_spike_begins_another_activation(play: Any) -> None:
    m = rs.Module("m")
    a, b, heard = m.signal("a", payload=int), m.signal("b", payload=int), list[Any]()

    @m.rule(when=a & b)
    async def pair(ctx: Any) -> None:
        heard.append((ctx.payload(a), ctx.payload(b)))

    with play(m) as sim:
        for number in (1, 2, 3):
            sim.emit(a, number)
        assert len(sim.explain("m:pair").activations) == 3
        for number in (1, 2, 3):
            sim.emit(b, number)
        assert heard == [(1, 1), (2, 2), (3, 3)]


def test_several_activations_can_hold_a_spike_but_only_one_gets_consent(play: Any) -> None:
    m = rs.Module("m")
    a, b, c, out = m.signal("a"), m.signal("b"), m.signal("c"), output(m)
    writer(m, "with_b", a & b, out)
    writer(m, "with_c", a & c, out)
    with play(m) as sim:
        sim.emit(a)
        holders = [one for rule in ("m:with_b", "m:with_c") for one in sim.explain(rule).activations]
        assert [[name for name, _ in one.holds] for one in holders] == [["m:a"], ["m:a"]]
        sim.emit(c)
        sim.advance(10.0)
        sim.emit(b)
        assert written(sim, out) == ["with_c"]


@pytest.mark.parametrize("writes", [True, False])
def test_the_older_of_two_waiting_prompts_takes_the_only_answer(play: Any, writes: bool) -> None:
    m = rs.Module("m")
    prompt, answer = m.signal("prompt", payload=int), m.signal("answer", payload=str)
    out, answered = m.slot("out", ""), list[Any]()

    @m.rule(when=prompt.max_age(None) & answer, writes=(out,) if writes else ())
    async def note(ctx: Any) -> None:
        answered.append((ctx.payload(prompt), ctx.payload(answer)))
        if writes:
            ctx[out] = ctx.payload(answer)

    with play(m) as sim:
        sim.emit(prompt, 1)
        sim.advance(3.0)
        sim.emit(prompt, 2)
        sim.advance(3.0)
        sim.emit(answer, "one")
        assert answered == [(1, "one")]
        sim.advance(100.0)
        assert answered == [(1, "one")]
        [waiting] = sim.explain("m:note").activations
        assert waiting.holds == (("m:prompt", 103.0),)
        sim.emit(answer, "two")
        assert answered == [(1, "one"), (2, "two")]
        sim.emit(answer, "three")
        sim.advance(10.0)
        assert answered == [(1, "one"), (2, "two")]


def utterances() -> tuple[rs.Module, rs.Slot[str], list[Any]]:
    """Declare rules on `question & about_agent`, both raised from the words of an utterance."""
    m = rs.Module("m")
    text = m.slot("text", "", always=True)
    question, about = m.signal("question"), m.signal("about")
    answered: list[Any] = []

    @m.rule(when=text.changed, emits=question)
    async def ask(ctx: Any) -> None:
        if "?" in ctx.payload(text.changed):
            ctx.emit(question, ctx.payload(text.changed))

    @m.rule(when=text.changed, emits=about)
    async def mention(ctx: Any) -> None:
        if "you" in ctx.payload(text.changed):
            ctx.emit(about, ctx.payload(text.changed))

    @m.rule(when=question.max_age(None) & about.max_age(None))
    async def both(ctx: Any) -> None:
        answered.append((ctx.payload(question), ctx.payload(about)))

    return m, text, answered


def test_a_question_in_one_utterance_never_joins_a_mention_in_another(play: Any) -> None:
    m, text, answered = utterances()
    with play(m) as sim:
        for words in ("who?", "you!", "what?", "you there!"):
            sim.put(text, words)
            sim.advance(0.1)
        assert answered == []


def test_the_signals_of_one_utterance_join(play: Any) -> None:
    m, text, answered = utterances()
    with play(m) as sim:
        sim.put(text, "who are you?")
        assert answered == [("who are you?", "who are you?")]


def test_an_utterance_is_answered_even_while_an_earlier_one_waits_for_its_second_signal(play: Any) -> None:
    m, text, answered = utterances()
    with play(m) as sim:
        for words in ("who?", "you!", "who are you?", "where are you?", "how?"):
            sim.put(text, words)
        assert answered == [("who are you?", "who are you?"), ("where are you?", "where are you?")]


def test_inputs_without_a_common_cause_can_join_from_two_groups(play: Any) -> None:
    m = rs.Module("m")
    point, speech, heard = m.signal("point"), m.signal("speech"), list[Any]()
    hearer(m, "fuse", point & speech, speech, heard)
    with play(m) as sim:
        sim.emit(point)
        sim.emit(speech, "there")
        assert heard == ["there"]


def test_coherence_extends_over_a_chain_of_causes(play: Any) -> None:
    m = rs.Module("m")
    i, x, y = m.signal("i", payload=str), m.signal("x"), m.signal("y")
    heard: list[Any] = []
    emitter(m, "one", i, x, only_if=lambda ctx: "x" in ctx.payload(i))
    emitter(m, "two", x, y)
    hearer(m, "join", i.where(lambda text: "j" in text) & y, i, heard)
    with play(m) as sim:
        sim.emit(i, "j")
        sim.emit(i, "x")
        assert heard == []
        sim.emit(i, "xj")
        assert heard == ["xj"]


def test_a_detached_constraint_does_not_have_to_cohere(play: Any) -> None:
    m, text, _ = utterances()
    seen: list[Any] = []

    @m.rule(when=m.signals[0] & m.signals[1].detached())
    async def loose(ctx: Any) -> None:
        seen.append((ctx.payload(m.signals[0]), ctx.payload(m.signals[1])))

    with play(m) as sim:
        sim.put(text, "you!")
        sim.put(text, "who?")
        assert seen == [("who?", "you!")]


def test_an_activation_that_loses_a_coherent_spike_takes_another_of_the_same_cause(play: Any) -> None:
    m = rs.Module("m")
    i, question, about, seal = (
        m.signal("i"),
        m.signal("question", payload=int),
        m.signal("about"),
        m.signal("seal"),
    )
    heard: list[Any] = []

    @m.rule(when=i, emits=(question, about))
    async def classify(ctx: Any) -> None:
        ctx.emit(question, 1)
        ctx.emit(about)
        await ctx.sleep(0.5)
        ctx.emit(question, 2)

    hearer(m, "join", question.max_age(1.0) & about.max_age(None) & seal, question, heard)
    with play(m) as sim:
        sim.emit(i)
        sim.advance(1.2)
        sim.emit(seal)
        assert heard == [2]


@pytest.mark.parametrize("order", ["ab", "ba"])
def test_spikes_whose_groups_have_merged_can_join(play: Any, order: str) -> None:
    m = rs.Module("m")
    a, b, s0, s1 = (m.signal(name) for name in ("a", "b", "s0", "s1"))
    emitter(m, "r0", b, s0)
    hearer(m, "r1", a & s0 & s1, s1, [])
    emitter(m, "r2", a & b, s1)
    with play(m) as sim:
        for name in order:
            sim.emit({"a": a, "b": b}[name])
        assert sim.fired == ["m:r0", "m:r2", "m:r1"]
        assert at_rest(sim)


def test_an_older_activation_takes_the_spikes_that_a_merge_brings_together(play: Any) -> None:
    m = rs.Module("m")
    a, b, s0, s1, heard = m.signal("a"), m.signal("b"), m.signal("s0"), m.signal("s1"), list[Any]()
    emitter(m, "r0", b, s0)
    hearer(m, "r1", a & s0 & s1, a, heard)
    emitter(m, "r2", a.where(lambda payload: payload != "other") & b, s1)
    with play(m) as sim:
        for payload in ("other", "first", "second"):
            sim.emit(a, payload)
        sim.emit(b)
        assert heard == ["first"]


def test_a_rule_gets_the_spikes_that_two_merges_bring_together(play: Any) -> None:
    m = rs.Module("m")
    a, b, s0, s1, heard = m.signal("a"), m.signal("b"), m.signal("s0"), m.signal("s1"), list[Any]()
    emitter(m, "r0", b, s0)
    emitter(m, "r2", a & b, s1)
    hearer(m, "r1", a & s0 & s1, a, heard)
    with play(m) as sim:
        sim.emit(a, "input")
        sim.emit(b)
        sim.advance(10.0)
        assert heard == ["input"]


def test_an_activation_that_has_lost_a_spike_can_take_spikes_of_other_groups(play: Any) -> None:
    m = rs.Module("m")
    a, s, v, out = m.signal("a"), m.signal("s"), m.signal("v"), output(m)
    emitter(m, "cause", a, s, only_if=lambda ctx: False)  # only declared so that `a` and `s` must cohere
    writer(m, "both", s.max_age(1.0) & a & v, out)
    with play(m) as sim:
        sim.emit(s)  # this begins one group
        sim.emit(v)
        sim.emit(a)  # this begins another group, so the first activation cannot hold both `s` and `a`
        sim.advance(1.0)
        held = {signal["signal"] for signal in sim.snapshot()["activations"][0]["holds"]}
        assert held == {"m:v", "m:a"}
