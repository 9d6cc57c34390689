"""A context starts once, takes calls from its loop and from other threads, and ends cleanly."""

import asyncio
import contextlib
import json
import logging
import math
import threading
from collections.abc import Callable
from typing import Any

import pytest

import ravestate as rs
from ravestate.runtime import async_rules, runner
from ravestate.runtime.async_rules import GRACE
from ravestate.runtime.runner import SETTLES
from ravestate.runtime.workers import SHARE
from ravestate.testing import simulate
from ravestate.testing.virtual_loop import VirtualLoop
from runtime.on_loop import on_loop, turns


class Options(rs.Settings):
    greeting: str = "hello"
    pause: float = 1.0


demo = rs.Module("demo", settings=Options)
heard, said = demo.slot("heard", ""), demo.slot("said", "", always=True)
number = demo.signal("number", payload=int)
people = demo.collection("people")


@demo.rule(when=heard.changed, writes=said)
async def echo(ctx: rs.RuleContext) -> None:
    ctx[said] = ctx.payload(heard.changed).upper()


@demo.rule(when=number, writes=said)
async def count(ctx: rs.RuleContext) -> None:
    ctx[said] = f"{ctx.settings.greeting} {ctx.payload(number)}"


policy = rs.compile(demo)


# ---------------------------------------------------------------------------------------- start and end


@on_loop
async def test_a_context_can_run_only_once() -> None:
    context = rs.Context(policy)
    async with context:
        assert context.now >= 0.0
    with pytest.raises(rs.EngineError, match="a context runs once: make another one of the same policy"):
        await context.__aenter__()


@pytest.mark.parametrize(
    "act",
    [
        lambda c: c.put(heard, "x"),
        lambda c: c.emit(number, 1),
        lambda c: c.wipe(number),
        lambda c: c.read(heard),
        lambda c: c.explain("demo:echo"),
        lambda c: c.snapshot(),
        lambda c: c.now,
        lambda c: c.add_rule(echo),
    ],
)
def test_a_context_that_has_not_started_refuses_every_call(act: Callable[[rs.Context], object]) -> None:
    with pytest.raises(rs.EngineError, match=r"has not started: write `async with rs\.Context"):
        act(rs.Context(policy))


@on_loop
async def test_a_context_that_has_not_started_refuses_waiting() -> None:
    context = rs.Context(policy)
    for wait in (context.next(number), context.quiet(), context.until_stopped(), context.stop()):
        with pytest.raises(rs.EngineError, match="has not started"):
            await wait


@on_loop
async def test_a_context_that_has_ended_can_only_be_read() -> None:
    async with rs.Context(policy) as context:
        context.put(heard, "x")
        await context.quiet()
    assert context.read(said) == "X"
    assert context.snapshot()["slots"]["demo:said"] == "X"
    assert str(context.explain(echo)).startswith("demo:echo at ")
    context.put(heard, "late")
    context.emit(number, 1)
    await turns()
    assert context.read(heard) == "x"
    with pytest.raises(rs.EngineError, match="the context has ended: there will be no demo:number"):
        await context.next(number)
    await context.stop()  # a second stop changes nothing


def test_calls_do_nothing_after_the_event_loop_has_closed() -> None:
    context = rs.Context(policy)

    async def main() -> None:
        async with context:
            pass

    asyncio.run(main())
    context.put(heard, "late")
    context.ask_to_stop()
    thread = threading.Thread(target=context.put, args=(heard, "late"))
    thread.start()
    thread.join()
    assert context.read(heard) == ""


@on_loop
async def test_an_exception_in_the_body_ends_the_context_and_is_raised_to_the_caller() -> None:
    with pytest.raises(KeyError):
        async with rs.Context(policy) as context:
            raise KeyError("mine")
    assert context.read(heard) == ""
    assert len(asyncio.all_tasks()) == 1


def test_faults_are_raised_before_anything_runs() -> None:
    with pytest.raises(rs.DeclarationErrors) as caught:
        rs.Context("demo")  # the name of a module is not a module
    assert "expected an rs.Module" in str(caught.value)
    with pytest.raises(rs.DeclarationErrors) as caught:
        rs.Context(policy, demo)
    assert "not <policy of 2 rules" in str(caught.value)


@pytest.mark.parametrize("patience", [-1, float("nan"), float("inf"), "1", None, True])
def test_patience_is_a_number_of_seconds(patience: Any) -> None:
    with pytest.raises(
        rs.DeclarationError, match=r"patience=.* must be a finite number of seconds, 0 or more, e.g. patience=1.0"
    ):
        rs.Context(policy, patience=patience)


# ---------------------------------------------------------------------------------------- calls from outside


@on_loop
async def test_context_next_returns_the_answer_to_a_put_or_an_emit() -> None:
    async with rs.Context(policy) as context:
        answer = asyncio.create_task(context.next(said.changed))
        await turns(1)
        context.put(heard, "hi")
        assert await answer == "HI"
        context.emit(number, 7)
        assert await context.next(said.changed, timeout=20) == "hello 7"


@on_loop
async def test_any_thread_can_call_put_emit_and_wipe() -> None:
    async with rs.Context(policy) as context:
        waiting = [asyncio.create_task(context.next(signal)) for signal in (heard.changed, number)]
        await turns(1)
        await asyncio.to_thread(context.put, heard, "hi")
        await asyncio.to_thread(context.emit, number, 7)
        await asyncio.to_thread(context.wipe, number)
        assert await asyncio.gather(*waiting) == ["hi", 7]
        with pytest.raises(rs.UndeclaredError):
            await asyncio.to_thread(context.emit, rs.Module("x").signal("y"))


@on_loop
async def test_calls_from_one_thread_keep_their_order() -> None:
    m = rs.Module("m")
    s, seen = m.signal("s", int), m.slot("seen", ())
    last = m.signal("last")

    @m.rule(when=s, writes=seen)
    async def note(ctx: rs.RuleContext) -> None:
        ctx[seen] = (*ctx[seen], ctx.payload(s))

    async with rs.Context(m) as context:

        def speak() -> None:
            for value in range(100):
                context.emit(s, value)
            context.emit(last)

        end = asyncio.create_task(context.next(last))
        await turns(1)
        await asyncio.to_thread(speak)
        await end
        await context.quiet()
        assert context.read(seen) == tuple(range(100))


@on_loop
async def test_several_tasks_can_wait_for_the_same_signal() -> None:
    async with rs.Context(policy) as context:
        waiting = [asyncio.create_task(context.next(number)) for _ in range(3)]
        await turns(1)
        context.emit(number, 0)
        assert await asyncio.gather(*waiting) == [0, 0, 0]


@on_loop
async def test_context_next_returns_a_spike_that_is_already_due_without_a_turn_of_the_event_loop(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(runner, "perf_counter", lambda: 0.0)  # on a slow machine, the loop would get its turn earlier
    async with rs.Context(policy) as context:
        ran: list[str] = []
        asyncio.get_running_loop().call_soon(ran.append, "the loop")
        context.put(heard, "hi")
        assert await context.next(said.changed) == "HI" and ran == []


@on_loop
async def test_the_event_loop_gets_turns_even_if_every_spike_is_already_due(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(runner, "perf_counter", lambda: 0.0)
    async with rs.Context(policy) as context:
        ran: list[int] = []
        asyncio.get_running_loop().call_soon(ran.append, 0)
        for number in range(SETTLES + 1):
            context.put(heard, f"hi {number}")
            await context.next(said.changed)
            assert number == SETTLES or ran == []
        assert ran == [0]


@on_loop
async def test_a_rule_does_not_run_in_the_task_that_waits_for_its_signal() -> None:
    own = rs.Module("own")
    asked, answered = own.signal("asked"), own.signal("answered")
    tasks: list[object] = []

    @own.rule(when=asked, emits=answered)
    async def answer(ctx: rs.RuleContext) -> None:
        tasks.append(asyncio.current_task())
        ctx.emit(answered)

    async with rs.Context(own) as context:
        context.emit(asked)
        await context.next(answered)
    assert tasks != [asyncio.current_task()] and asyncio.current_task() is not None


@on_loop
async def test_context_next_refuses_a_timeout_that_never_ends_because_it_is_nan() -> None:
    async with rs.Context(policy) as context:
        with pytest.raises(ValueError, match=r"next\(timeout=nan\): write a number of seconds"):
            await context.next(number, timeout=math.nan)


@on_loop
async def test_context_next_raises_an_error_after_its_timeout() -> None:
    async with rs.Context(policy) as context:
        with pytest.raises(TimeoutError, match="no demo:number within 0 s"):
            await context.next(number, timeout=0)
        with pytest.raises(TimeoutError, match=r"no demo:number within 0\.001 s"):
            await context.next(number, timeout=0.001)
        waiting = asyncio.create_task(context.next(number))
        await turns(1)
        waiting.cancel()
        await turns()
        assert waiting.cancelled()


@on_loop
async def test_tasks_that_wait_for_a_signal_get_an_error_when_the_context_ends() -> None:
    async with rs.Context(policy) as context:
        waiting = asyncio.create_task(context.next(number))
        await turns(1)
    with pytest.raises(rs.EngineError, match="the context ended before there was a demo:number"):
        await waiting


@on_loop
async def test_context_quiet_waits_for_running_rules_but_only_until_the_context_ends() -> None:
    m = rs.Module("m")
    go, done = m.signal("go"), m.slot("done", 0)
    gate = asyncio.Event()

    @m.rule(when=go, writes=done)
    async def work(ctx: rs.RuleContext) -> None:
        await gate.wait()
        ctx[done] = 1

    @m.rule(when=rs.startup, background=True)
    async def watch(ctx: rs.RuleContext) -> None:
        await asyncio.get_running_loop().create_future()

    async with rs.Context(m) as context:
        await context.quiet()  # does not wait for background rules
        context.emit(go)
        waiting = asyncio.create_task(context.quiet())
        await turns()
        assert not waiting.done()
        gate.set()
        await waiting
        assert context.read(done) == 1
        gate.clear()
        context.emit(go)
        waiting = asyncio.create_task(context.quiet())
        await turns()
    await waiting  # the end of the context has cancelled the rule


@on_loop
async def test_context_quiet_does_not_wait_for_background_rules() -> None:
    m = rs.Module("m")
    go, done = m.signal("go"), m.slot("done", 0)

    @m.rule(when=go, writes=done, background=True, weight=2.0)
    async def keep(ctx: rs.RuleContext) -> None:
        await asyncio.get_running_loop().create_future()

    @m.rule(when=go, writes=done, background=True)
    async def wait(ctx: rs.RuleContext) -> None:
        """A rule that waits for the slot that `keep` has taken."""

    async with rs.Context(m) as context:
        context.emit(go)
        await asyncio.wait_for(context.quiet(), 20.0)
        assert "waits for m:keep" in str(context.explain("m:wait"))


@on_loop
async def test_context_put_immediately_refuses_a_value_of_the_wrong_type() -> None:
    m = rs.Module("m")
    heard = m.slot("heard", "", type=str)
    async with rs.Context(m) as context:
        with pytest.raises(rs.RuleError, match=r"context\.put wrote 42 to m:heard, which takes str, not int"):
            context.put(heard, 42)  # type: ignore[arg-type]


# ---------------------------------------------------------------------------------------- wrong names


@pytest.mark.parametrize(
    ("act", "text"),
    [
        (lambda c: c.put(rs.Module("demo").slot("hear"), 1), "no slot demo:hear; did you mean 'demo:heard'?"),
        (lambda c: c.put(rs.Module("xy").slot("z"), 1), "no slot xy:z; add module xy to the context"),
        (lambda c: c.put("heard", 1), "this context has no slot 'heard'"),
        (
            lambda c: c.emit(rs.Module("demo").signal("numbr")),
            "no signal demo:numbr; did you mean 'demo:number'?",
        ),
        (lambda c: c.emit(heard), "no signal demo:heard; it is a slot: write demo.heard.changed"),
        (lambda c: c.wipe(heard), "it is a slot: write demo.heard.changed"),
        (lambda c: c.read(number), "this context has no slot demo:number"),
        (lambda c: c.read(rs.Module("demo").slot("heard")), "this context has no slot demo:heard"),
    ],
)
@on_loop
async def test_names_that_the_context_lacks_are_refused(act: Callable[[rs.Context], object], text: str) -> None:
    async with rs.Context(policy) as context:
        with pytest.raises(rs.UndeclaredError) as caught:
            act(context)
        assert text in str(caught.value)


@on_loop
async def test_waiting_for_an_unknown_signal_is_refused() -> None:
    async with rs.Context(policy) as context:
        with pytest.raises(rs.UndeclaredError, match="it is a slot"):
            await context.next(heard)
        with pytest.raises(rs.DeclarationError, match="no rule 'demo:ecko'; did you mean 'demo:echo'"):
            context.explain("demo:ecko")


@on_loop
async def test_context_put_accepts_only_a_mapping_for_a_collection() -> None:
    async with rs.Context(policy) as context:
        with pytest.raises(rs.RuleError, match="demo:people is a collection: write a mapping of keys to items"):
            context.put(people, ["Ada"])
        context.put(people, {"a": "Ada"})
        assert dict(context.read(people)) == {"a": "Ada"}


# ---------------------------------------------------------------------------------------- observation


@on_loop
async def test_slots_have_separate_values_in_each_context() -> None:
    m = rs.Module("m")
    things = m.slot("things", ["a"])
    async with rs.Context(m) as one, rs.Context(m) as other:
        one.read(things).append("b")
        assert other.read(things) == ["a"] and things.default == ["a"]


@on_loop
async def test_a_snapshot_is_plain_data() -> None:
    async with rs.Context(policy) as context:
        context.put(people, {"a": object()})
        context.emit(number, 1)
        found = json.loads(json.dumps(context.snapshot()))
        assert found["slots"]["demo:people"]["a"].startswith("<object object")
        assert {"now", "slots", "spikes", "activations", "groups", "dropped", "retired"} <= set(found)


@on_loop
async def test_a_trace_can_be_kept_passed_to_a_function_or_switched_off() -> None:
    told: list[object] = []
    for trace in (False, True, told.append):
        async with rs.Context(policy, trace=trace) as context:
            context.put(heard, "x")
            await context.quiet()
            kept = [type(record).__name__ for record in context.trace]
            assert ("Started" in kept) == (trace is True)
            assert ("finished" in str(context.explain(echo))) == (trace is True)
    assert "Started" in [type(record).__name__ for record in told]


# ---------------------------------------------------------------------------------------- settings, seed


@on_loop
async def test_settings_come_from_code_or_the_environment() -> None:
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("RAVESTATE_DEMO_GREETING", "salut")
        patch.setenv("RAVESTATE_DEMO_PAUSE", "4")
        async with rs.Context(policy, settings={"demo": {"greeting": "hallo"}}) as context:
            assert context.settings == {"demo": Options(greeting="hallo", pause=4.0)}
            context.emit(number, 1)
            await context.quiet()
            assert context.read(said) == "hallo 1"


def test_unknown_settings_are_refused() -> None:
    with pytest.raises(rs.DeclarationErrors) as caught:
        rs.Context(policy, settings={"demo": {"greting": "x"}, "dmo": {}})
    assert "setting demo.greting: module 'demo' has no such setting; did you mean 'greeting'?" in str(caught.value)
    assert "module 'dmo' is not part of this agent; did you mean 'demo'?" in str(caught.value)


def test_numbers_in_declarations_follow_the_settings_of_the_context() -> None:
    m = rs.Module("m", settings=Options)
    s, done = m.signal("s"), m.slot("done", 0)

    @m.rule(when=s.min_age(Options.pause), writes=done)
    async def late(ctx: rs.RuleContext) -> None:
        ctx[done] = ctx.now

    with simulate(m, settings={"m": {"pause": 3.0}}) as sim:
        sim.emit(s)
        sim.advance(10)
        assert sim.read(done) == 3.0


def rolls(seed: int | None) -> list[float]:
    m = rs.Module("m")
    s, seen = m.signal("s"), m.slot("seen", ())

    @m.rule(when=s, writes=seen)
    async def roll(ctx: rs.RuleContext) -> None:
        ctx[seen] = (*ctx[seen], ctx.random.random())

    with simulate(m, seed=seed) as sim:
        for _ in range(3):
            sim.emit(s)
        return list(sim.read(seen))


def test_a_seed_repeats_all_random_choices() -> None:
    assert rolls(5) == rolls(5) != rolls(6)
    assert rolls(None) != rolls(None)


# ---------------------------------------------------------------------------------------- rules that come later


@on_loop
async def test_a_rule_can_be_added_to_one_context() -> None:
    rule = rs.Module("more").rule(when=number, writes=said, weight=2.0, name="louder")(loud)
    async with rs.Context(policy) as one, rs.Context(policy) as other:
        one.add_rule(rule)
        for context in (one, other):
            context.emit(number, 1)
            await context.quiet()
        assert (one.read(said), other.read(said)) == ("LOUD", "hello 1")
        assert list(one.policy.rules)[-1] == "more:louder" and list(policy.rules) == [
            "demo:echo",
            "demo:count",
        ]
        with pytest.raises(rs.DeclarationErrors) as caught:
            one.add_rule(rule)
        assert "is in the policy already" in str(caught.value)


async def loud(ctx: rs.RuleContext) -> None:
    ctx[said] = "LOUD"


def test_an_added_rule_follows_the_settings_of_the_context() -> None:
    m = rs.Module("m", settings=Options)
    s, done = m.signal("s"), m.slot("done", 0)
    with simulate(m, settings={"m": {"pause": 3.0}}) as sim:

        @rs.Module("m").rule(when=s.min_age(Options.pause), writes=done)
        async def late(ctx: rs.RuleContext) -> None:
            ctx[done] = ctx.now

        sim.add_rule(late)
        sim.emit(s)
        sim.advance(10)
        assert sim.read(done) == 3.0


# ---------------------------------------------------------------------------------------- the end


class Ending:
    """A module whose rules record how they end with the context."""

    def __init__(self) -> None:
        self.module = rs.Module("m")
        self.go, self.then = self.module.signal("go"), self.module.signal("then")
        self.told: list[str] = []

    def rule(self, when: rs.Condition, **options: Any) -> Callable[[Any], Any]:
        return self.module.rule(when=when, **options)


def test_shutdown_lets_rules_for_shutdown_finish_and_then_cancels_other_runs() -> None:
    ending = Ending()

    @ending.rule(ending.go)
    async def long(ctx: rs.RuleContext) -> None:
        try:
            await ctx.sleep(3600)
        finally:
            await ctx.sleep(1)
            ending.told.append("cleaned up")

    @ending.rule(rs.shutdown, emits=ending.then)
    async def farewell(ctx: rs.RuleContext) -> None:
        await ctx.sleep(2)
        ending.told.append("farewell")
        ctx.emit(ending.then)

    @ending.rule(ending.then)
    async def last_word(ctx: rs.RuleContext) -> None:
        await ctx.sleep(1)
        ending.told.append("last word")

    with simulate(ending.module) as sim:
        sim.emit(ending.go)
    assert ending.told == ["farewell", "last word", "cleaned up"]
    assert sim.failures == []


def test_a_rule_for_shutdown_runs_even_if_a_rival_first_keeps_it_waiting() -> None:
    ending = Ending()
    out = ending.module.slot("out", "")

    @ending.rule(rs.shutdown, writes=out)
    async def farewell(ctx: rs.RuleContext) -> None:
        ending.told.append(f"farewell at {ctx.now:g} s")

    @ending.rule(rs.shutdown & ending.go, writes=out)
    async def better(ctx: rs.RuleContext) -> None:
        ending.told.append("never")

    with simulate(ending.module):
        pass
    assert ending.told == ["farewell at 1 s"]


def test_a_rule_for_shutdown_is_not_cut_off_when_shutdown_interrupts_another_rule() -> None:
    ending = Ending()

    @ending.rule(ending.go, until=rs.shutdown)
    async def long(ctx: rs.RuleContext) -> None:
        await ctx.sleep(3600)

    @ending.rule(rs.shutdown)
    async def farewell(ctx: rs.RuleContext) -> None:
        await ctx.sleep(1)
        ending.told.append("farewell")

    with simulate(ending.module) as sim:
        sim.emit(ending.go)
    assert ending.told == ["farewell"]


def test_a_rule_that_also_waits_for_shutdown_is_not_cut_off_while_a_long_rule_runs() -> None:
    ending = Ending()
    never = ending.module.signal("never")

    @ending.rule(ending.go & rs.shutdown, emits=never)
    async def farewell(ctx: rs.RuleContext) -> None:
        await ctx.sleep(1)
        ending.told.append("farewell")

    @ending.rule(ending.then)
    async def long(ctx: rs.RuleContext) -> None:
        await ctx.sleep(3600)

    with simulate(ending.module) as sim:
        sim.emit(ending.go)
        sim.emit(ending.then)
    assert ending.told == ["farewell"]


def test_shutdown_does_not_wait_for_a_background_loop() -> None:
    ending = Ending()

    @ending.rule(rs.startup | ending.go, emits=ending.go, detached=True, background=True)
    async def tick(ctx: rs.RuleContext) -> None:
        await ctx.sleep(0.1)
        ctx.emit(ending.go)

    @ending.rule(rs.shutdown)
    async def farewell(ctx: rs.RuleContext) -> None:
        await ctx.sleep(0.35)
        ending.told.append("farewell")

    @ending.rule(rs.startup)
    async def long(ctx: rs.RuleContext) -> None:
        try:
            await ctx.sleep(3600)
        finally:
            ending.told.append(f"{ctx.now:g} s")

    with simulate(ending.module) as sim:
        sim.advance(1)
    assert ending.told == ["farewell", "1.35 s"]


def test_shutdown_does_not_wait_for_an_endless_background_rule_that_waits_for_rest() -> None:
    ending = Ending()

    @ending.rule(rs.activity.false.max_age(None), background=True)
    async def endless(ctx: rs.RuleContext) -> None:
        try:
            await ctx.sleep(3600)
        finally:
            ending.told.append(f"cancelled at {ctx.now:g} s")

    @ending.rule(rs.shutdown)
    async def farewell(ctx: rs.RuleContext) -> None:
        await ctx.sleep(1)
        ending.told.append("farewell")

    async def stop_at_once() -> None:
        async with rs.Context(ending.module):
            pass

    with asyncio.Runner(loop_factory=VirtualLoop) as loop:
        loop.run(stop_at_once())
    assert ending.told == ["farewell", "cancelled at 1 s"]


def test_shutdown_waits_for_a_background_rule_whose_input_comes_just_before() -> None:
    """A robot must get its last command, such as the one that stops its motors."""
    ending = Ending()

    @ending.rule(ending.go, background=True)
    async def send(ctx: rs.RuleContext) -> None:
        await ctx.sleep(0.5)
        ending.told.append("sent")

    async def stop_at_once() -> None:
        async with rs.Context(ending.module) as ctx:
            await ctx.quiet()
            ctx.emit(ending.go)

    with asyncio.Runner(loop_factory=VirtualLoop) as loop:
        loop.run(stop_at_once())
    assert ending.told == ["sent"]


def test_shutdown_waits_for_rules_that_need_an_age_and_for_their_detached_effects() -> None:
    ending = Ending()

    @ending.rule(rs.shutdown.min_age(0.5), emits=ending.then, detached=True)
    async def farewell(ctx: rs.RuleContext) -> None:
        ctx.emit(ending.then)

    @ending.rule(ending.then, background=True)
    async def speak(ctx: rs.RuleContext) -> None:
        await ctx.sleep(1)
        ending.told.append(f"{ctx.now:g} s")

    with simulate(ending.module):
        pass
    assert ending.told == ["1.5 s"]


@on_loop
async def test_functions_that_hang_do_not_keep_other_rules_from_running() -> None:
    ending = Ending()
    release = threading.Event()

    @ending.rule(ending.go, timeout=0.01)
    def hang(ctx: rs.RuleContext) -> None:
        release.wait(20)

    @ending.rule(ending.then)
    def speak(ctx: rs.RuleContext) -> None:
        ending.told.append("spoken")

    async with rs.Context(ending.module) as context:
        for _ in range(SHARE + 8):
            context.emit(ending.go)
        await context.quiet()
        context.emit(ending.then)
        await context.quiet()
    release.set()
    assert ending.told == ["spoken"]


def test_no_rule_starts_while_cancelled_rules_clean_up_at_the_end(caplog: pytest.LogCaptureFixture) -> None:
    ending = Ending()

    @ending.rule(ending.go, emits=ending.then)
    async def long(ctx: rs.RuleContext) -> None:
        try:
            await ctx.sleep(3600)
        finally:
            ctx.emit(ending.then)
            await ctx.sleep(1)
            ending.told.append("cleaned up")

    @ending.rule(ending.then)
    async def too_late(ctx: rs.RuleContext) -> None:
        ending.told.append("begun")
        await ctx.sleep(3600)

    with simulate(ending.module) as sim:
        sim.emit(ending.go)
    assert ending.told == ["cleaned up"]
    assert not caplog.records


def test_other_rules_continue_after_a_rule_has_raised_keyboard_interrupt() -> None:
    ending = Ending()

    @ending.rule(ending.go)
    async def interrupt(ctx: rs.RuleContext) -> None:
        raise KeyboardInterrupt

    @ending.rule(ending.go)
    async def other(ctx: rs.RuleContext) -> None:
        ending.told.append("other")

    context = rs.Context(ending.module)
    with contextlib.closing(asyncio.new_event_loop()) as loop:
        loop.run_until_complete(context.start())
        context.emit(ending.go)
        with pytest.raises(KeyboardInterrupt):
            loop.run_until_complete(context.quiet())
        loop.run_until_complete(context.quiet())
        assert ending.told == ["other"]
        loop.run_until_complete(context.stop())


def test_a_rule_that_ends_when_it_is_interrupted_causes_no_warning(
    caplog: pytest.LogCaptureFixture,
) -> None:
    ending = Ending()

    @ending.rule(ending.go, until=ending.then)
    async def long(ctx: rs.RuleContext) -> None:
        await ctx.sleep(3600)

    with simulate(ending.module) as sim:
        sim.emit(ending.go)
        sim.emit(ending.then)
        sim.advance(2 * GRACE)
        assert sim.fired == ["m:long"] and not caplog.records


def test_a_rule_for_shutdown_is_cancelled_after_five_seconds() -> None:
    ending = Ending()

    @ending.rule(rs.shutdown)
    async def farewell(ctx: rs.RuleContext) -> None:
        try:
            await ctx.sleep(3600)
        finally:
            ending.told.append(f"cut off at {ctx.now:g} s")

    with simulate(ending.module):
        pass
    assert ending.told == ["cut off at 5 s"]


@on_loop
async def test_a_plain_function_for_shutdown_finishes() -> None:
    ending = Ending()

    @ending.rule(rs.shutdown)
    def farewell(ctx: rs.RuleContext) -> None:
        ending.told.append("farewell")

    async with rs.Context(ending.module):
        pass
    assert ending.told == ["farewell"]


def test_a_rule_that_refuses_to_end_is_abandoned_and_a_warning_names_it(caplog: pytest.LogCaptureFixture) -> None:
    ending = Ending()

    @ending.rule(ending.go)
    async def stubborn(ctx: rs.RuleContext) -> None:
        try:
            while True:
                try:
                    await ctx.sleep(3600)
                except asyncio.CancelledError:
                    ending.told.append("no")
        finally:
            ending.told.append("closed")

    with caplog.at_level(logging.WARNING, "ravestate"), simulate(ending.module) as sim:
        sim.emit(ending.go)
    assert ending.told == ["no", "closed"]
    (message,) = caplog.messages
    assert message.startswith("rule m:stubborn (") and "did not end within 5 s of being cancelled" in message


@on_loop
async def test_a_rule_that_refuses_to_end_does_not_keep_the_process_alive() -> None:
    ending = Ending()

    @ending.rule(ending.go)
    async def stubborn(ctx: rs.RuleContext) -> None:
        while True:
            try:
                await asyncio.get_running_loop().create_future()
            except asyncio.CancelledError:
                ending.told.append("no")

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(async_rules, "GRACE", 0.001)
        async with rs.Context(ending.module) as context:
            context.emit(ending.go)
            await turns()
    assert ending.told == ["no"]
    assert len(asyncio.all_tasks()) == 1


@on_loop
async def test_a_cancelled_shutdown_does_not_wait_for_rules() -> None:
    ending = Ending()

    @ending.rule(rs.shutdown)
    async def slow(ctx: rs.RuleContext) -> None:
        try:
            await asyncio.get_running_loop().create_future()
        finally:
            ending.told.append("broken off")

    context = rs.Context(ending.module)
    await context.__aenter__()
    end = asyncio.create_task(context.stop())
    await turns()
    assert not end.done() and ending.told == []
    end.cancel()
    with pytest.raises(asyncio.CancelledError):
        await end
    assert ending.told == ["broken off"]
    assert len(asyncio.all_tasks()) == 1


@on_loop
async def test_a_task_can_wait_for_a_write_of_a_rule_for_shutdown() -> None:
    ending = Ending()
    goodbye = ending.module.slot("goodbye", "")

    @ending.rule(rs.shutdown, writes=goodbye)
    async def farewell(ctx: rs.RuleContext) -> None:
        ctx[goodbye] = "bye"

    async with rs.Context(ending.module) as context:
        word = asyncio.create_task(context.next(goodbye.changed))
        await turns(1)
    assert await word == "bye" == context.read(goodbye)


@pytest.mark.parametrize("who", ["rule", "plain rule", "outside", "thread"])
@on_loop
async def test_rules_and_other_code_in_any_thread_can_ask_the_context_to_stop(who: str) -> None:
    ending = Ending()

    @ending.rule(ending.go)
    async def leave(ctx: rs.RuleContext) -> None:
        ctx.stop()

    @ending.rule(ending.then)
    def leave_from_thread(ctx: rs.RuleContext) -> None:
        ctx.stop()

    async with rs.Context(ending.module) as context:
        waiting = asyncio.create_task(context.until_stopped())
        await turns(1)
        assert not waiting.done()
        if who == "rule":
            context.emit(ending.go)
        elif who == "plain rule":
            context.emit(ending.then)
        elif who == "outside":
            context.ask_to_stop()
        else:
            await asyncio.to_thread(context.ask_to_stop)
        await waiting
