"""Why a rule did not fire: `why_not` gives the right reason in each case."""

import asyncio
import math
import sys
from collections.abc import Callable
from pathlib import Path
from types import FrameType
from typing import Any

import pytest

import ravestate as rs
from ravestate.board.answer import WhyNot
from ravestate.board.description import describe
from ravestate.board.recorder import Gap
from ravestate.board.source import gates_of
from ravestate.board.why_not import MOST, why_not
from ravestate.board.wire import checked_record, data_of
from ravestate.engine.reasons import LossReason, PassReason, Verdict
from ravestate.engine.trace import Born, GaveUp, Passed, Settled, Started
from ravestate.testing import Simulation, simulate


class Stage:
    """A module with two inputs and an output. Each test adds rules."""

    def __init__(self) -> None:
        self.module = rs.Module("demo")
        self.input = self.module.slot("input", "", always=True)
        self.touch = self.module.signal("touch")
        self.output = self.module.slot("output", "", always=True)

    def run(self, patience: float = 1.0) -> Simulation:
        return simulate(self.module, patience=patience)


@pytest.fixture
def stage() -> Stage:
    return Stage()


def spike_of(sim: Simulation, signal: str, number: int = 0) -> int:
    return [r.spike for r in sim.trace if isinstance(r, Born) and r.signal == signal][number]


def ask(sim: Simulation, rule: str, signal: str = "demo:input:changed", number: int = 0) -> WhyNot:
    policy = sim.context.policy
    found = why_not(sim.trace, describe(policy), f"demo:{rule}", spike_of(sim, signal, number), gates_of(policy))
    assert str(found)  # every explanation has a text
    return found


def answer_late(stage: Stage, question: rs.Signal[Any]) -> None:
    """Declare a rule that gives up its input before a question can come."""

    @stage.module.rule(when=stage.input.changed.max_age(1.0) & question, writes=stage.output)
    async def qa(ctx: rs.RuleContext) -> None: ...


def conversation(stage: Stage, is_question: bool, resigns: bool = False, slow: float = 0.0) -> None:
    """Declare a classifier, a rule that answers questions, and small talk for all other inputs."""
    question = stage.module.signal("question")

    @stage.module.rule(when=stage.input.changed, emits=question)
    async def classify(ctx: rs.RuleContext) -> None:
        if slow:
            await ctx.sleep(slow)
        if is_question:
            ctx.emit(question)

    @stage.module.rule(when=question, writes=stage.output)
    async def qa(ctx: rs.RuleContext) -> rs.Resign | None:
        if resigns:
            return rs.Resign("it does not know")
        ctx[stage.output] = "an answer"
        return None

    @stage.module.rule(when=stage.input.changed, writes=stage.output)
    async def talk(ctx: rs.RuleContext) -> None:
        ctx[stage.output] = "small talk"


def test_a_rule_that_fired_is_reported_as_fired(stage: Stage) -> None:
    conversation(stage, is_question=True)
    with stage.run() as sim:
        sim.put(stage.input, "?")
        found = ask(sim, "qa")
    assert found.verdict == "fired"
    assert found.words == "it fired at 0.000 s and wrote demo:output"
    assert [moment.words for moment in found.moments] == [
        "took demo:question and has all it needs", "started", "finished",
    ]  # fmt: skip


def test_why_not_says_that_a_better_rule_answered(stage: Stage) -> None:
    conversation(stage, is_question=True, slow=2.0)
    with stage.run() as sim:
        sim.put(stage.input, "?")
        assert ask(sim, "talk").verdict == "waiting"
        sim.advance(2)
        found = ask(sim, "talk")
    assert found.verdict == "outrun"
    nats = math.log(3)
    assert found.words == (
        f"it was ready and waited for demo:qa ({nats:.3f} nats ahead); demo:classify → demo:qa answered at 2.000 s"
    )
    assert found.at == 2.0
    assert ("demo:qa",) in [moment.rules for moment in found.moments]


@pytest.mark.parametrize(
    ("weight", "late", "reason"),
    [
        (1.2, True, "both utilities are 0, greater weight × recovery"),
        (1.0, False, "equal utility, declared earlier"),
    ],
)
def test_why_not_says_what_decides_between_rules_with_a_utility_of_0(
    stage: Stage, weight: float, late: bool, reason: str
) -> None:
    async def answer(ctx: rs.RuleContext) -> None:
        ctx[stage.output] = "answer"

    def declare_rival() -> None:
        stage.module.rule(when=stage.touch.min_age(1), writes=stage.output, weight=weight, name="rival")(answer)

    if not late:
        declare_rival()
    stage.module.rule(when=stage.touch, writes=stage.output, name="quick")(answer)
    if late:
        declare_rival()
    with stage.run() as sim:
        sim.emit(stage.touch)
        found = ask(sim, "quick", "demo:touch")
    assert found.words == f"it has been ready since 0.000 s and waits for demo:rival ({reason})"


def test_why_not_names_no_lead_of_a_rule_that_is_behind(stage: Stage) -> None:
    """Two rules worth 0 take turns: after its run, the heavier rule has recovered less."""

    async def answer(ctx: rs.RuleContext) -> None:
        ctx[stage.output] = "answer"

    stage.module.rule(when=stage.touch, writes=stage.output, name="steady")(answer)
    stage.module.rule(when=stage.touch, writes=stage.output, name="heavy", weight=2.0, cooldown=10.0)(answer)
    with stage.run() as sim:
        sim.emit(stage.touch)
        sim.advance(1)
        sim.emit(stage.touch)
        assert ask(sim, "heavy", "demo:touch", 0).verdict == "fired"
        found = ask(sim, "heavy", "demo:touch", 1)
    assert found.verdict == "outrun"
    assert "demo:steady (both utilities are 0, greater weight × recovery)" in found.words


def test_why_not_says_that_no_rule_raised_a_signal_for_this_cause(stage: Stage) -> None:
    conversation(stage, is_question=False)
    with stage.run() as sim:
        sim.put(stage.input, "hello")
        found = ask(sim, "qa")
    assert found.verdict == "untouched"
    (missing,) = found.missing
    assert missing.words == "demo:question did not occur"
    (raiser,) = missing.raisers
    assert (raiser.rule, raiser.outcome) == ("demo:classify", "done")
    assert raiser.words == "demo:classify finished without raising it, at 0.000 s"


def test_why_not_says_when_a_missing_signal_was_raised_not_when_the_run_of_its_raiser_ended(stage: Stage) -> None:
    question = stage.module.signal("question")

    @stage.module.rule(when=stage.input.changed, emits=question)
    async def classify(ctx: rs.RuleContext) -> rs.Resign:
        await ctx.sleep(2.0)
        ctx.emit(question)
        await ctx.sleep(3.0)
        return rs.Resign("there is nothing more to classify")

    answer_late(stage, question)
    with stage.run() as sim:
        sim.put(stage.input, "?")
        sim.advance(2.5)
        (running,) = ask(sim, "qa").missing[0].raisers
        sim.advance(4.0)
        (resigned,) = ask(sim, "qa").missing[0].raisers
    assert running.words == resigned.words == "demo:classify raised it, at 2.000 s"
    assert (running.outcome, running.time) == ("running", None)
    assert (resigned.outcome, resigned.time) == ("resigned", 5.0)


def test_why_not_finds_the_run_that_raised_a_missing_signal_among_several_runs(stage: Stage) -> None:
    part = stage.module.signal("part", payload=str)
    question = stage.module.signal("question")

    @stage.module.rule(when=stage.input.changed, emits=part)
    async def split(ctx: rs.RuleContext) -> None:
        for word in ("who", "me"):
            ctx.emit(part, word)
            await ctx.sleep(2.0)

    @stage.module.rule(when=part, emits=question)
    async def classify(ctx: rs.RuleContext) -> None:
        await ctx.sleep(1.5)
        if ctx.payload(part) == "who":
            ctx.emit(question)

    answer_late(stage, question)
    with stage.run() as sim:
        sim.put(stage.input, "who me")
        sim.advance(8.0)
        (raiser,) = ask(sim, "qa").missing[0].raisers
    assert (raiser.words, raiser.time) == ("demo:classify raised it, at 1.500 s", 1.5)


def test_why_not_says_which_signal_a_rule_lacks_again_after_it_lost_a_spike(stage: Stage) -> None:
    @stage.module.rule(when=stage.input.changed & stage.touch.max_age(60), writes=stage.output)
    async def both(ctx: rs.RuleContext) -> None:
        ctx[stage.output] = "both"

    @stage.module.rule(when=stage.input.changed, writes=stage.output, weight=100.0)
    async def one(ctx: rs.RuleContext) -> None:
        ctx[stage.output] = "one"

    @stage.module.rule(when=stage.touch)
    async def feel(ctx: rs.RuleContext) -> None: ...

    with stage.run() as sim:
        sim.emit(stage.touch)
        sim.advance(0.1)
        sim.put(stage.input, "hello")
        sim.advance(4)
        found = ask(sim, "both", "demo:touch")
    assert found.verdict == "lacked"
    assert "it has demo:touch and still lacks demo:input:changed" in str(found)


def test_why_not_says_that_the_rule_resigned_with_its_reason(stage: Stage) -> None:
    conversation(stage, is_question=True, resigns=True)
    with stage.run() as sim:
        sim.put(stage.input, "?")
        found, other = ask(sim, "qa"), ask(sim, "talk")
    assert found.verdict == "resigned"
    assert found.words == "it ran at 0.000 s and resigned: it does not know"
    assert other.verdict == "fired"


def test_why_not_says_whether_a_rule_failed_before_or_after_its_write(stage: Stage) -> None:
    @stage.module.rule(when=stage.input.changed, writes=stage.output)
    async def early(ctx: rs.RuleContext) -> None:
        raise ValueError("no such word")

    @stage.module.rule(when=stage.touch, writes=stage.output)
    async def late(ctx: rs.RuleContext) -> None:
        ctx[stage.output] = "half"
        raise ValueError("no such word")

    with stage.run() as sim:
        sim.put(stage.input, "x")
        sim.emit(stage.touch)
        first, second = ask(sim, "early"), ask(sim, "late", "demo:touch")
    assert first.verdict == "failed"
    assert first.words.startswith("it ran at 0.000 s and failed: ValueError('no such word') (test_why_not.py:")
    assert second.verdict == "fired"
    assert "failed after its write" in second.words


def test_why_not_says_that_the_payload_did_not_fit(stage: Stage) -> None:
    @stage.module.rule(when=stage.input.changed.where(str.isupper), writes=stage.output)
    async def shout(ctx: rs.RuleContext) -> None: ...

    with stage.run() as sim:
        sim.put(stage.input, "quiet")
        found = ask(sim, "shout")
    assert found.verdict == "passed"
    assert found.words == "it did not take demo:input:changed: its payload did not match the predicate"


def test_why_not_names_the_rule_that_had_already_answered_the_cause(stage: Stage) -> None:
    later = stage.module.signal("later")

    @stage.module.rule(when=stage.input.changed, writes=stage.output)
    async def quick(ctx: rs.RuleContext) -> None:
        ctx[stage.output] = "quick"

    @stage.module.rule(when=stage.output.changed, emits=later)
    async def follow(ctx: rs.RuleContext) -> None:
        ctx.emit(later)

    @stage.module.rule(when=later, writes=stage.output, weight=0.01)
    async def again(ctx: rs.RuleContext) -> None: ...

    with stage.run() as sim:
        sim.put(stage.input, "x")
        found = ask(sim, "again")
    assert found.verdict in ("passed", "outrun")
    assert "demo:quick" in found.words


@pytest.mark.parametrize("named", [True, False], ids=["new trace", "older trace"])
def test_a_detached_rule_does_not_count_as_the_answer_to_the_cause(stage: Stage, named: bool) -> None:
    later = stage.module.signal("later")

    @stage.module.rule(when=stage.input.changed.detached(), writes=stage.output)
    async def echo(ctx: rs.RuleContext) -> None:
        ctx[stage.output] = "hm"

    @stage.module.rule(when=stage.input.changed, emits=later, background=True)
    async def slow(ctx: rs.RuleContext) -> None:
        await ctx.sleep(1)
        ctx.emit(later)

    @stage.module.rule(when=stage.input.changed.where(bool), writes=stage.output, weight=5)
    async def answer(ctx: rs.RuleContext) -> None:
        ctx[stage.output] = "answer"

    @stage.module.rule(when=later, writes=stage.output, weight=0.001)
    async def too_late(ctx: rs.RuleContext) -> None: ...

    with stage.run() as sim:
        sim.put(stage.input, "x")
        sim.advance(5)
        assert sim.fired == ["demo:echo", "demo:answer", "demo:slow"]
        run = next(r.run for r in sim.trace if isinstance(r, Started) and r.rule == "demo:answer")
        passed = [r for r in sim.trace if isinstance(r, Passed) and r.rule == "demo:too_late"]
        assert [(p.reason, p.by, p.run) for p in passed] == [("consumed", "demo:answer", run)]
        kept = [data_of(record) for record in sim.trace]
        for record in kept:
            if record["kind"] == "passed" and not named:
                del record["by"], record["run"]  # older files lack these fields
        records = [record for record in map(checked_record, kept) if not isinstance(record, Gap)]
        spike = spike_of(sim, "demo:input:changed")
        found = why_not(records, describe(sim.context.policy), "demo:too_late", spike)
    assert found.verdict == "passed"
    assert found.words == "it did not take demo:later: demo:answer had already answered this cause"


def test_why_not_names_the_right_rule_even_if_causes_merge_later(stage: Stage) -> None:
    other, late = stage.module.slot("other", ""), stage.module.signal("late")

    @stage.module.rule(when=stage.touch, writes=stage.output)
    async def first(ctx: rs.RuleContext) -> None:
        ctx[stage.output] = "first"

    @stage.module.rule(when=stage.input.changed, writes=stage.output)
    async def second(ctx: rs.RuleContext) -> None:
        ctx[stage.output] = "second"

    @stage.module.rule(when=stage.input.changed, emits=late, background=True)
    async def slow(ctx: rs.RuleContext) -> None:
        await ctx.sleep(1)
        ctx.emit(late)

    @stage.module.rule(when=late, writes=stage.output, weight=0.001)
    async def too_late(ctx: rs.RuleContext) -> None: ...

    @stage.module.rule(when=stage.touch & late, writes=other)
    async def both(ctx: rs.RuleContext) -> None:
        ctx[other] = "both"

    with stage.run() as sim:
        sim.emit(stage.touch)
        sim.put(stage.input, "x")
        sim.advance(5)
        assert "demo:both" in sim.fired
        found = ask(sim, "too_late")
    assert found.words == "it did not take demo:late: demo:second had already answered this cause"


def test_why_not_says_that_the_rule_itself_was_among_the_causes_of_a_spike(stage: Stage) -> None:
    @stage.module.rule(when=stage.input.changed | stage.output.changed, writes=stage.output)
    async def echo(ctx: rs.RuleContext) -> None:
        ctx[stage.output] = "echo"

    with stage.run() as sim:
        sim.put(stage.input, "x")
        found = ask(sim, "echo")
    assert found.verdict == "fired"
    assert "did not take demo:output:changed: the rule itself was among its causes" in [
        moment.words for moment in found.moments
    ]


def test_why_not_says_that_an_input_did_not_arrive_before_a_spike_was_too_old(stage: Stage) -> None:
    @stage.module.rule(when=stage.input.changed & stage.touch)
    async def both(ctx: rs.RuleContext) -> None: ...

    with stage.run() as sim:
        sim.put(stage.input, "x")
        now = ask(sim, "both")
        sim.advance(6)
        found = ask(sim, "both")
    assert now.verdict == "lacked"
    assert now.words == "it has demo:input:changed and still lacks demo:touch"
    assert found.verdict == "lacked"
    assert found.words == (
        "it took demo:input:changed but lacked demo:touch; demo:input:changed reached its maximum age of 5 s at 5.000 s"
    )
    assert found.missing[0].words == "demo:touch is an input and did not arrive"


def test_why_not_names_the_rules_that_can_raise_a_missing_input(stage: Stage) -> None:
    rung = stage.module.signal("rung", input=True)

    @stage.module.rule(when=stage.touch, emits=rung)
    async def ring(ctx: rs.RuleContext) -> None: ...

    @stage.module.rule(when=stage.input.changed & rung)
    async def both(ctx: rs.RuleContext) -> None: ...

    with stage.run() as sim:
        sim.put(stage.input, "x")
        sim.advance(6)
        (missing,) = ask(sim, "both").missing
    assert missing.words == "demo:rung did not arrive as an input, and no rule raised it"
    assert [raiser.rule for raiser in missing.raisers] == ["demo:ring"]


def test_why_not_says_that_the_patience_ran_out_while_another_rule_waited(stage: Stage) -> None:
    @stage.module.rule(when=stage.input.changed & stage.touch, writes=stage.output)
    async def fused(ctx: rs.RuleContext) -> None: ...

    @stage.module.rule(when=stage.input.changed, writes=stage.output)
    async def plain(ctx: rs.RuleContext) -> None:
        ctx[stage.output] = "plain"

    with stage.run() as sim:
        sim.put(stage.input, "x")
        waits = ask(sim, "plain")
        sim.advance(2)
        found = ask(sim, "fused")
    assert waits.verdict == "waiting"
    assert waits.words.endswith("until 1.000 s at the latest")
    assert found.verdict == "eliminated"
    assert found.words == (
        "it took demo:input:changed but lacked demo:touch; demo:plain waited for it from 0.000 s on, and "
        "this rule's patience ran out at 1.000 s"
    )


def test_why_not_says_that_a_predicate_on_a_slot_was_false(stage: Stage) -> None:
    awake = stage.module.flag("awake")

    @stage.module.rule(when=stage.input.changed & awake.holds(bool))
    async def react(ctx: rs.RuleContext) -> None: ...

    with stage.run() as sim:
        sim.put(stage.input, "x")
        assert ask(sim, "react").verdict == "gated"
        sim.advance(6)
        found = ask(sim, "react")
    assert found.verdict == "gated"
    assert found.words.startswith("it had all its spikes, but demo:awake.holds(bool) was false")


def test_why_not_blames_a_false_predicate_even_if_another_rule_answered(stage: Stage) -> None:
    awake = stage.module.flag("awake")

    @stage.module.rule(when=stage.input.changed & awake.holds(bool), writes=stage.output)
    async def react(ctx: rs.RuleContext) -> None: ...

    @stage.module.rule(when=stage.input.changed, writes=stage.output)
    async def plain(ctx: rs.RuleContext) -> None:
        ctx[stage.output] = "plain"

    with stage.run() as sim:
        sim.put(awake, True)
        sim.put(awake, False)
        sim.put(stage.input, "x")
        found = ask(sim, "react")
    assert found.verdict == "gated"
    assert "demo:plain answered this cause" in found.words


def test_why_not_says_that_a_spike_was_too_young(stage: Stage) -> None:
    @stage.module.rule(when=stage.input.changed.min_age(3.0), writes=stage.output)
    async def slow(ctx: rs.RuleContext) -> None: ...

    @stage.module.rule(when=stage.input.changed, writes=stage.output, weight=9)
    async def quick(ctx: rs.RuleContext) -> None:
        ctx[stage.output] = "quick"

    with stage.run() as sim:
        sim.put(stage.input, "x")
        found = ask(sim, "slow")
    assert found.verdict == "young"
    assert "demo:input:changed must be 3 s old, so the rule could not run before 3.000 s" in found.words


def test_why_not_names_the_answering_rule_together_with_the_rule_before_it(stage: Stage) -> None:
    conversation(stage, is_question=True, slow=2.0)
    with stage.run() as sim:
        sim.put(stage.input, "?")
        sim.advance(2)
        found = ask(sim, "talk")
    assert found.moments[-1].words == "gave up demo:input:changed: demo:classify → demo:qa answered it"
    assert found.moments[-1].rules == ("demo:qa",)


def test_why_not_mentions_repeated_waits_only_once(stage: Stage) -> None:
    @stage.module.rule(when=stage.input.changed, emits=stage.touch)
    async def notice(ctx: rs.RuleContext) -> None:
        await ctx.sleep(1)
        ctx.emit(stage.touch)

    conversation(stage, is_question=True, slow=2.0)
    with stage.run() as sim:
        sim.put(stage.input, "?")
        sim.advance(3)
        words = [moment.words for moment in ask(sim, "talk").moments]
    assert any("waited for" in told for told in words)
    assert len(words) == len(set(words))


def test_why_not_says_that_the_rule_had_retired(stage: Stage) -> None:
    @stage.module.rule(when=stage.input.changed)
    async def once(ctx: rs.RuleContext) -> rs.Retire:
        return rs.Retire()

    with stage.run() as sim:
        sim.put(stage.input, "x")
        sim.advance(1)
        sim.put(stage.input, "y")
        first, second = ask(sim, "once"), ask(sim, "once", number=1)
    assert first.verdict == "fired"
    assert (second.verdict, second.words) == ("retired", "it had already retired, at 0.000 s")


def test_why_not_says_that_a_spike_was_withdrawn(stage: Stage) -> None:
    @stage.module.rule(when=stage.input.changed & stage.touch)
    async def both(ctx: rs.RuleContext) -> None: ...

    with stage.run() as sim:
        sim.put(stage.input, "x")
        sim.wipe(stage.input.changed)
        found = ask(sim, "both")
    assert found.verdict == "withdrawn"
    assert found.words == "demo:input:changed was withdrawn at 0.000 s: it was wiped"


@pytest.mark.parametrize(
    ("retires", "words"),
    [
        (False, "it ran at 0.000 s and was stopped because its spike was wiped"),
        (True, "it ran at 0.000 s, was stopped because its spike was wiped and retired: it cannot go on"),
    ],
)
def test_why_not_says_that_a_run_was_stopped_because_its_spike_was_wiped(
    stage: Stage, retires: bool, words: str
) -> None:
    @stage.module.rule(when=stage.touch, writes=stage.output)
    async def slow(ctx: rs.RuleContext) -> rs.Retire | None:
        try:
            await ctx.sleep(5)
        except asyncio.CancelledError:
            if retires:
                return rs.Retire("it cannot go on")
            raise
        return None

    with stage.run() as sim:
        sim.emit(stage.touch)
        sim.advance(1)
        sim.wipe(stage.touch)
        sim.advance(1)
        found = ask(sim, "slow", "demo:touch")
    assert (found.verdict, found.at) == ("withdrawn", 1.0)
    assert found.words == words
    assert found.missing == ()


def test_why_not_names_the_rule_that_had_taken_the_slot(stage: Stage) -> None:
    @stage.module.rule(when=stage.input.changed, writes=stage.output, weight=2)
    async def long(ctx: rs.RuleContext) -> None:
        await ctx.sleep(3)
        ctx[stage.output] = "at last"

    @stage.module.rule(when=stage.input.changed, writes=stage.output)
    async def short(ctx: rs.RuleContext) -> None: ...

    with stage.run() as sim:
        sim.put(stage.input, "x")
        sim.advance(1)
        waiting = ask(sim, "short")
        sim.advance(3)
        found = ask(sim, "short")
    assert waiting.verdict == "waiting"
    assert "demo:long, which was running and had taken demo:output" in waiting.words
    assert found.verdict == "outrun"
    assert found.words.endswith("demo:long answered at 3.000 s")


def test_why_not_names_the_rule_declared_first_among_equal_rules(stage: Stage) -> None:
    @stage.module.rule(when=stage.input.changed, writes=stage.output)
    async def first(ctx: rs.RuleContext) -> None:
        await asyncio.sleep(0)
        ctx[stage.output] = "first"

    @stage.module.rule(when=stage.input.changed, writes=stage.output)
    async def second(ctx: rs.RuleContext) -> None: ...

    with stage.run() as sim:
        sim.put(stage.input, "x")
        found = ask(sim, "second")
    assert found.verdict == "outrun"
    assert "demo:first" in found.words


def test_why_not_can_be_asked_about_a_later_input(stage: Stage) -> None:
    conversation(stage, is_question=False)
    with stage.run() as sim:
        sim.put(stage.input, "one")
        sim.advance(1)
        sim.put(stage.input, "two")
        found = ask(sim, "talk", number=1)
    assert found.verdict == "fired"
    assert found.time == 1.0
    assert all(moment.time == 1.0 for moment in found.moments)


def test_why_not_says_that_a_signal_occurred_only_for_another_cause(stage: Stage) -> None:
    question = stage.module.signal("question")

    @stage.module.rule(when=stage.input.changed.where(lambda text: "?" in text), emits=question)
    async def classify(ctx: rs.RuleContext) -> None:
        ctx.emit(question)

    @stage.module.rule(when=question, writes=stage.output)
    async def qa(ctx: rs.RuleContext) -> None:
        ctx[stage.output] = "answer"

    with stage.run() as sim:
        sim.put(stage.input, "how?")
        sim.advance(1)
        sim.put(stage.input, "hello")
        found = ask(sim, "qa", number=1)
    assert found.verdict == "untouched"
    assert found.missing[0].words == "demo:question did not occur for this cause (only for another cause, at 0.000 s)"
    assert found.missing[0].raisers[0].words == (
        "demo:classify did not run: it did not take demo:input:changed: its payload did not match the predicate"
    )


def test_missing_signals_are_explained_backwards_even_if_rules_form_a_circle(stage: Stage) -> None:
    one, two = stage.module.signal("one", input=True), stage.module.signal("two")

    @stage.module.rule(when=stage.touch & two, emits=one)
    async def to_one(ctx: rs.RuleContext) -> None: ...

    @stage.module.rule(when=one | stage.touch & one, emits=two)
    async def to_two(ctx: rs.RuleContext) -> None: ...

    @stage.module.rule(when=stage.touch & one & two)
    async def both(ctx: rs.RuleContext) -> None: ...

    with stage.run() as sim:
        sim.emit(stage.touch)
        sim.advance(6)
        found = ask(sim, "both", "demo:touch")
    assert found.verdict == "lacked"
    assert [missing.signal for missing in found.missing] == ["demo:one", "demo:two"]
    assert "demo:to_one did not run: it took demo:touch but lacked demo:two" in found.missing[0].raisers[0].words


def test_a_running_rule_is_reported_as_running(stage: Stage) -> None:
    @stage.module.rule(when=stage.input.changed)
    async def dream(ctx: rs.RuleContext) -> None:
        await ctx.sleep(100)

    with stage.run() as sim:
        sim.put(stage.input, "x")
        found = ask(sim, "dream")
        sim.advance(100)
    assert (found.verdict, found.words) == ("running", "it has been running since 0.000 s")


def test_an_unknown_rule_or_spike_is_refused(stage: Stage) -> None:
    conversation(stage, is_question=False)
    with stage.run() as sim:
        sim.put(stage.input, "x")
        view = describe(sim.context.policy)
        with pytest.raises(LookupError, match="spike 9999 is not in the history"):
            why_not(sim.trace, view, "demo:talk", 9999)
        with pytest.raises(LookupError, match="there is no rule 'demo:tlak'"):
            why_not(sim.trace, view, "demo:tlak", 1)


def test_an_explanation_from_an_incomplete_trace_says_that_it_is_incomplete(stage: Stage) -> None:
    conversation(stage, is_question=False)
    with stage.run() as sim:
        sim.put(stage.input, "x")
        spike = spike_of(sim, "demo:input:changed")
        late = [record for record in sim.trace if getattr(record, "spike", spike) >= spike]
        found = why_not(late, describe(sim.context.policy), "demo:talk", spike, whole=False)
    assert not found.whole


def shut_while_waiting(stage: Stage) -> rs.Slot[bool]:
    """Declare a rule with a predicate on a slot, and a better rule for which it waits. Return the slot."""
    lit = stage.module.slot("lit", True)

    @stage.module.rule(when=stage.input.changed & lit.holds(bool), writes=stage.output)
    async def gated(ctx: rs.RuleContext) -> None:
        ctx[stage.output] = "gated"

    @stage.module.rule(when=stage.input.changed & stage.touch, writes=stage.output, weight=3)
    async def fused(ctx: rs.RuleContext) -> None: ...

    return lit


def test_a_rule_whose_predicate_became_false_during_a_wait_is_reported_as_gated(stage: Stage) -> None:
    lit = shut_while_waiting(stage)
    with stage.run() as sim:
        sim.put(stage.input, "x")
        waits = ask(sim, "gated")
        sim.advance(0.5)
        sim.put(lit, False)
        sim.advance(2.5)
        now = ask(sim, "gated")
        sim.advance(3)
        assert sim.fired == []
        found = ask(sim, "gated")
        described = describe(sim.context.policy)
        unseen = why_not(sim.trace, described, "demo:gated", spike_of(sim, "demo:input:changed"))
    assert waits.verdict == "waiting"
    assert now.verdict == found.verdict == "gated"
    assert "another rule" not in str(found)
    assert found.words.startswith("it was ready and waited for demo:fused (")
    assert found.words.endswith(
        "nats ahead); then demo:lit.holds(bool) was false; demo:input:changed reached its maximum age of 5 s at 5.000 s"
    )
    assert unseen.verdict == "gated"  # like a recording, this description does not contain the functions of predicates


def test_a_waiting_rule_that_lost_while_its_predicate_was_false_is_reported_as_gated(stage: Stage) -> None:
    lit = shut_while_waiting(stage)

    @stage.module.rule(when=stage.input.changed, writes=stage.output, weight=0.1)
    async def plain(ctx: rs.RuleContext) -> None:
        ctx[stage.output] = "plain"

    with stage.run() as sim:
        sim.put(stage.input, "x")
        sim.advance(0.5)
        sim.put(lit, False)
        sim.advance(3)
        found = ask(sim, "gated")
        assert sim.fired == ["demo:plain"]
    assert found.verdict == "gated"
    assert "then demo:lit.holds(bool) was false; demo:plain answered this cause at 1.000 s" in found.words


def test_a_waiting_rule_whose_predicate_is_true_is_reported_as_waiting(stage: Stage) -> None:
    shut_while_waiting(stage)
    with stage.run() as sim:
        sim.put(stage.input, "x")
        found = ask(sim, "gated")
        assert found.verdict == "waiting"
        sim.emit(stage.touch)
        assert ask(sim, "gated").verdict == "outrun"


def test_why_not_does_not_name_a_rule_that_ran_for_another_cause(stage: Stage) -> None:
    boot, ready = stage.module.signal("boot"), stage.module.signal("ready")

    @stage.module.rule(when=boot, emits=ready)
    async def warm_up(ctx: rs.RuleContext) -> None:
        ctx.emit(ready)

    @stage.module.rule(when=ready.max_age(None).detached() & stage.input.changed, writes=stage.output)
    async def answer(ctx: rs.RuleContext) -> None:
        ctx[stage.output] = "answer"

    @stage.module.rule(when=stage.input.changed, writes=stage.output, weight=0.1)
    async def talk(ctx: rs.RuleContext) -> None: ...

    with stage.run() as sim:
        sim.emit(boot)
        sim.advance(1)
        sim.put(stage.input, "x")
        found = ask(sim, "talk")
    assert found.verdict == "outrun"
    assert found.moments[-1].words == "gave up demo:input:changed: demo:answer answered it"
    assert "warm_up" not in str(found)


def two_runs(stage: Stage) -> None:
    """Declare a rule that reacts to the signals of two other rules. The first of its two runs resigns."""
    soon, late = stage.module.signal("soon"), stage.module.signal("late")
    asked: list[float] = []

    @stage.module.rule(when=stage.input.changed, emits=soon)
    async def first(ctx: rs.RuleContext) -> None:
        ctx.emit(soon)

    @stage.module.rule(when=stage.input.changed, emits=late)
    async def second(ctx: rs.RuleContext) -> None:
        ctx.emit(late)

    @stage.module.rule(when=late | soon, writes=stage.output)
    async def say(ctx: rs.RuleContext) -> rs.Resign | None:
        asked.append(ctx.now)
        if len(asked) == 1:
            return rs.Resign("not yet")
        ctx[stage.output] = "said"
        return None

    @stage.module.rule(when=stage.input.changed, writes=stage.output, weight=0.1)
    async def talk(ctx: rs.RuleContext) -> None: ...


def test_why_not_names_the_run_that_answered_and_not_the_run_that_resigned(stage: Stage) -> None:
    two_runs(stage)
    with stage.run() as sim:
        sim.put(stage.input, "x")
        found = ask(sim, "talk")
        ends = {r.outcome: r.run for r in sim.trace if isinstance(r, Settled) and r.rule == "demo:say"}
        (lost,) = [r for r in sim.trace if isinstance(r, GaveUp) and r.rule == "demo:talk"]
    assert set(ends) == {"resigned", "done"}
    assert (lost.by, lost.run) == ("demo:say", ends["done"])
    assert found.moments[-1].words == "gave up demo:input:changed: demo:first → demo:say answered it"
    assert "demo:second" not in str(found)


def test_for_an_older_trace_without_run_numbers_why_not_names_only_the_rule(stage: Stage) -> None:
    two_runs(stage)
    with stage.run() as sim:
        sim.put(stage.input, "x")
        kept = [data_of(record) for record in sim.trace]
        for record in kept:
            if record["kind"] == "gaveup":
                del record["run"]  # older files lack this field
        records = [record for record in map(checked_record, kept) if not isinstance(record, Gap)]
        spike = spike_of(sim, "demo:input:changed")
        found = why_not(records, describe(sim.context.policy), "demo:talk", spike)
    assert found.verdict == "outrun"
    assert found.moments[-1].words == "gave up demo:input:changed: demo:say answered it"


def many(stage: Stage, ticks: int, slow: float) -> Simulation:
    """Declare two rules that compete for the many spikes of one cause. One rule wins, and the other loses each time."""
    tick = stage.module.signal("tick")

    @stage.module.rule(when=stage.touch, emits=tick)
    async def pulse(ctx: rs.RuleContext) -> None:
        for _ in range(ticks):
            ctx.emit(tick)

    @stage.module.rule(when=tick, writes=stage.output)
    async def best(ctx: rs.RuleContext) -> None:
        if slow:
            await ctx.sleep(slow)
        ctx[stage.output] = "best"

    @stage.module.rule(when=tick, writes=stage.output)
    async def other(ctx: rs.RuleContext) -> None: ...

    return stage.run()


def steps(work: Callable[[], object]) -> int:
    """Count the lines of Python that a function executes."""
    count = 0

    def watch(frame: FrameType, event: str, arg: object) -> Any:
        nonlocal count
        count += event == "line"
        return watch

    before = sys.gettrace()
    sys.settrace(watch)
    try:
        work()
    finally:
        sys.settrace(before)
    return count


@pytest.mark.parametrize("slow", [0.0, 1.0], ids=["loses immediately", "waits first"])
def test_the_work_of_why_not_grows_only_in_proportion_to_the_history(slow: float) -> None:
    def cost(ticks: int) -> int:
        stage = Stage()
        with many(stage, ticks, slow) as sim:
            sim.emit(stage.touch)
            sim.advance(3)
            assert sim.fired == ["demo:pulse", "demo:best"]
            described, spike = describe(sim.context.policy), spike_of(sim, "demo:touch")
            records = list(sim.trace)
            return steps(lambda: why_not(records, described, "demo:other", spike))

    assert cost(200) < 2.3 * cost(100)


def test_a_very_long_explanation_leaves_out_the_moments_in_the_middle(stage: Stage) -> None:
    with many(stage, 300, 1.0) as sim:
        sim.emit(stage.touch)
        sim.advance(3)
        found = ask(sim, "other", "demo:touch")
    assert len(found.moments) == MOST
    assert found.moments[0].words == "took demo:tick and has all it needs"
    assert found.moments[-1].words == "gave up demo:tick: demo:pulse → demo:best answered it"
    (left,) = [moment for moment in found.moments if "left out" in moment.words]
    assert left.words == "701 more moments, until 1.000 s, are left out"
    assert [moment.time for moment in found.moments] == sorted(moment.time for moment in found.moments)


def test_a_run_with_an_end_but_no_start_is_reported_as_fired(stage: Stage) -> None:
    conversation(stage, is_question=False)
    with stage.run() as sim:
        sim.put(stage.input, "x")
        records = [record for record in sim.trace if not isinstance(record, Started)]
        spike = spike_of(sim, "demo:input:changed")
        found = why_not(records, describe(sim.context.policy), "demo:talk", spike)
    assert found.verdict == "fired"


def test_the_sources_of_the_page_repeat_no_phrase_of_the_enumerations() -> None:
    """The phrases of `ravestate.engine.reasons` reach the page only through its generated file, ``protocol.ts``."""
    phrases = [reason.words for kind in (LossReason, PassReason, Verdict) for reason in kind]
    for file in (Path(__file__).parents[2] / "frontend/src/board").glob("*.*"):
        if file.name != "protocol.ts":
            text = file.read_text(encoding="utf-8")
            assert [phrase for phrase in phrases if f'"{phrase}"' in text] == [], file
