"""`simulate` runs the real runtime in virtual time."""

import asyncio
import gc
import math
from asyncio import sleep  # in these tests, `sleep` takes only virtual time
from typing import Any

import pytest

import ravestate as rs
from ravestate.engine.trace import Started
from ravestate.modules import rawio
from ravestate.testing import simulate


class Options(rs.Settings):
    greeting: str = "hello"


def talk() -> rs.Module:
    """Return a module that greets, answers and says goodbye."""
    module = rs.Module("talk", requires=[rawio], settings=Options)

    @module.rule(when=rs.startup, writes=rawio.output)
    async def greet(ctx: rs.RuleContext) -> None:
        ctx[rawio.output] = ctx.settings.greeting

    @module.rule(when=rawio.input.changed, writes=rawio.output)
    async def answer(ctx: rs.RuleContext) -> rs.Resign | None:
        if not ctx.payload(rawio.input.changed):
            return rs.Resign("nothing was said")
        await ctx.sleep(2)
        ctx[rawio.output] = ctx.payload(rawio.input.changed).upper()
        return None

    @module.rule(when=rs.shutdown, writes=rawio.output)
    async def farewell(ctx: rs.RuleContext) -> None:
        ctx[rawio.output] = "bye"

    return module


def clock() -> tuple[rs.Module, rs.Signal[Any], list[float]]:
    """Return a module, its only signal, and an empty list to which its rules can add times."""
    module = rs.Module("clock")
    return module, module.signal("go"), []


# ---------------------------------------------------------------------------------------- what a simulation records


def test_the_attribute_said_lists_every_output_from_startup_to_the_end() -> None:
    with simulate(talk()) as sim:
        assert sim.said == ["hello"]
        sim.say("you")
        assert sim.said == ["hello"]
        sim.advance(2)
        assert sim.said == ["hello", "YOU"]
    assert sim.said == ["hello", "YOU", "bye"]


def test_the_attribute_fired_lists_the_rules_that_did_not_resign_in_the_order_of_their_ends() -> None:
    module, go, _ = clock()

    @module.rule(when=go)
    async def slow(ctx: rs.RuleContext) -> None:
        await ctx.sleep(1)

    @module.rule(when=go)
    async def quick(ctx: rs.RuleContext) -> None:
        pass

    @module.rule(when=go)
    async def shy(ctx: rs.RuleContext) -> rs.Resign:
        return rs.Resign("no")

    with simulate(module) as sim:
        sim.emit(go)
        assert sim.fired == ["clock:quick"]
        sim.advance(1)
        assert sim.fired == ["clock:quick", "clock:slow"]


def test_the_attribute_failures_lists_each_failed_rule_with_its_exception(caplog: pytest.LogCaptureFixture) -> None:
    module, go, _ = clock()

    @module.rule(when=rs.startup)
    async def early(ctx: rs.RuleContext) -> None:
        raise ValueError("early")

    @module.rule(when=go)
    async def late(ctx: rs.RuleContext) -> None:
        raise KeyError("late")

    with simulate(module) as sim:
        sim.emit(go)
        assert [(rule, type(error)) for rule, error in sim.failures] == [
            ("clock:early", ValueError), ("clock:late", KeyError),
        ]  # fmt: skip
        assert sim.fired == []
    assert [record.levelname for record in caplog.records] == ["ERROR", "ERROR"]


def test_the_trace_can_be_switched_off() -> None:
    with simulate(talk()) as sim:
        assert [record.rule for record in sim.trace if isinstance(record, Started)] == ["talk:greet"]
        assert "talk:greet at 0.000 s" in str(sim.explain("talk:greet"))
    with simulate(talk(), trace=False) as sim:
        sim.say("x")
        assert list(sim.trace) == []


def test_the_shortcuts_act_on_the_context() -> None:
    module, go, _ = clock()
    value = module.slot("value", 0)

    @module.rule(when=go.max_age(None) & value.changed)
    async def both(ctx: rs.RuleContext) -> None:
        pass

    with simulate(module) as sim:
        sim.emit(go, "payload")
        assert sim.snapshot()["spikes"][0]["payload"] == "payload"
        sim.wipe(go)
        sim.put(value, 5)
        assert sim.read(value) == 5 and sim.fired == []

        @module.rule(when=value.changed)
        async def later(ctx: rs.RuleContext) -> None:
            pass

        sim.add_rule(later)
        sim.put(value, 6)
        assert sim.fired == ["clock:later"]


def test_simulate_uses_the_given_settings_and_seed() -> None:
    with simulate(talk(), settings={"talk": {"greeting": "salut"}}) as sim:
        assert sim.said == ["salut"]
    module, go, found = clock()

    @module.rule(when=go)
    async def roll(ctx: rs.RuleContext) -> None:
        found.append(ctx.random.random())

    for seed in ({}, {}, {"seed": 1}):
        with simulate(module, **seed) as sim:
            sim.emit(go)
    assert found[0] == found[1] != found[2]


def test_simulate_uses_the_given_patience_in_virtual_time() -> None:
    module, go, found = clock()
    point, out = module.signal("point"), module.slot("out", "")

    @module.rule(when=go & point, writes=out)
    async def fused(ctx: rs.RuleContext) -> None:
        pass

    @module.rule(when=go, writes=out)
    async def alone(ctx: rs.RuleContext) -> None:
        found.append(ctx.now)

    with simulate(module, patience=0.25) as sim:
        sim.emit(go)
        sim.advance(10)
    assert found == [0.25]


# ---------------------------------------------------------------------------------------- virtual time


async def nested(depth: int) -> None:
    await sleep(0.5)
    if depth:
        await nested(depth - 1)


def test_every_kind_of_wait_takes_virtual_time() -> None:
    module, go, at = clock()

    @module.rule(when=go)
    async def by_sleep(ctx: rs.RuleContext) -> None:
        await sleep(3600)
        at.append(ctx.now)

    @module.rule(when=go)
    async def by_call_later(ctx: rs.RuleContext) -> None:
        future: asyncio.Future[None] = asyncio.get_running_loop().create_future()
        asyncio.get_running_loop().call_later(1800, future.set_result, None)
        await future
        at.append(ctx.now)

    @module.rule(when=go)
    async def by_timeout(ctx: rs.RuleContext) -> None:
        try:
            async with asyncio.timeout(900):
                await asyncio.get_running_loop().create_future()
        except TimeoutError:
            at.append(ctx.now)

    @module.rule(when=go)
    async def by_nested_tasks(ctx: rs.RuleContext) -> None:
        async with asyncio.TaskGroup() as group:
            group.create_task(nested(3))
            group.create_task(nested(7))
        at.append(ctx.now)

    with simulate(module) as sim:
        sim.emit(go)
        sim.advance(3599)
        assert at == [4.0, 900.0, 1800.0]
        sim.advance(1)
        assert at == [4.0, 900.0, 1800.0, 3600.0] and sim.now == 3600.0
        assert sim.failures == []


def test_plain_functions_take_no_virtual_time() -> None:
    module, go, at = clock()
    done = module.slot("done", 0)

    @module.rule(when=go, writes=done)
    def plain(ctx: rs.RuleContext) -> None:
        ctx[done] = sum(range(1000))
        at.append(ctx.now)

    @module.rule(when=done.changed)
    async def after(ctx: rs.RuleContext) -> None:
        at.append(await asyncio.to_thread(lambda: ctx.now))

    with simulate(module) as sim:
        sim.advance(1)
        sim.emit(go)
        assert sim.read(done) == 499500 and at == [1.0, 1.0]
        assert sim.failures == []


def test_plain_functions_run_one_after_another_in_the_order_of_declaration() -> None:
    module, go, _ = clock()
    inside: list[str] = []
    order: list[str] = []
    for name in "abcdef":

        def plain(ctx: rs.RuleContext, name: str = name) -> None:
            inside.append(name)
            order.append(name)
            assert inside == [name]
            inside.remove(name)

        module.rule(when=go, name=name)(plain)
    with simulate(module) as sim:
        sim.emit(go)
        assert order == list("abcdef") and sim.failures == []


def test_the_error_names_a_plain_function_that_holds_virtual_time_back(monkeypatch: pytest.MonkeyPatch) -> None:
    import threading

    from ravestate.testing import virtual_loop

    monkeypatch.setattr(virtual_loop, "REAL_LIMIT", 0.001)
    module, go, _ = clock()
    release = threading.Event()

    @module.rule(when=go)
    def hang(ctx: rs.RuleContext) -> None:
        release.wait(20)

    sim = simulate(module)
    with pytest.raises(TimeoutError) as caught, sim:
        sim.emit(go)
    assert str(caught.value) == (
        "clock:hang kept virtual time waiting for over 0.001 real seconds: a plain function takes real time; to wait in "
        "virtual time, write async def and await ctx.sleep(seconds)"
    )
    release.set()


# ---------------------------------------------------------------------------------------- advance, settle


def test_the_method_advance_settles_before_and_after_and_stops_at_the_exact_time() -> None:
    module, go, at = clock()

    @module.rule(when=go)
    async def late(ctx: rs.RuleContext) -> None:
        await ctx.sleep(2)
        at.append(ctx.now)

    with simulate(module) as sim:
        assert sim.now == 0.0
        sim.context.emit(go)  # does not settle, unlike `sim.emit`
        sim.advance(2)
        assert at == [2.0] and sim.now == 2.0
        sim.advance(0)
        assert sim.now == 2.0
        sim.advance(0.125)
        assert sim.now == 2.125


def test_advancing_in_parts_has_the_same_effect_as_one_advance() -> None:
    def times(parts: list[float]) -> list[float]:
        module, go, at = clock()

        @module.rule(when=go, emits=go, detached=True)
        async def again(ctx: rs.RuleContext) -> None:
            await ctx.sleep(0.7)
            at.append(ctx.now)
            ctx.emit(go)

        with simulate(module) as sim:
            sim.emit(go)
            for part in parts:
                sim.advance(part)
            return list(at)

    assert times([7.0]) == times([0.5] * 14) == times([3.25, 3.75]) != []


def test_the_method_settle_does_everything_that_is_due_now() -> None:
    module, go, at = clock()

    @module.rule(when=go)
    async def steps(ctx: rs.RuleContext) -> None:
        for _ in range(10):
            await sleep(0)
        at.append(ctx.now)
        await ctx.sleep(0.001)
        at.append(ctx.now)

    with simulate(module) as sim:
        sim.context.emit(go)
        sim.settle()
        assert at == [0.0]
        sim.settle()
        assert at == [0.0]


def test_the_method_advance_refuses_a_negative_time() -> None:
    with simulate() as sim, pytest.raises(ValueError, match=r"advance\(-1\): time does not run backwards"):
        sim.advance(-1)


@pytest.mark.parametrize("seconds", [math.nan, math.inf])
def test_the_method_advance_refuses_a_time_that_never_comes(seconds: float) -> None:
    with simulate() as sim, pytest.raises(ValueError, match=rf"advance\({seconds}\): write a finite number of seconds"):
        sim.advance(seconds)


# ---------------------------------------------------------------------------------------- wrong use


def test_a_simulation_inside_a_running_loop_is_refused() -> None:
    async def main() -> None:
        with pytest.raises(rs.EngineError, match="simulate runs a loop of its own: use it in a plain function"):
            simulate().__enter__()

    asyncio.run(main())


def test_a_simulation_can_be_used_only_within_its_with_block_and_only_once() -> None:
    sim = simulate()
    for act in (lambda: sim.advance(1), sim.settle, lambda: sim.now):
        with pytest.raises(rs.EngineError, match="has not started: write"):
            act()
    with sim:
        pass
    for act in (lambda: sim.emit(rs.startup), lambda: sim.advance(1), sim.settle, lambda: sim.__exit__()):
        with pytest.raises(rs.EngineError, match="has ended: act on it inside its `with` block"):
            act()
    assert sim.now == 0.0
    with pytest.raises(rs.EngineError, match="a context runs once"):
        sim.__enter__()


def test_the_method_say_raises_an_error_that_names_rawio_if_rawio_is_missing() -> None:
    with (
        simulate() as sim,
        pytest.raises(rs.UndeclaredError, match="no slot rawio:input; add module rawio to the context"),
    ):
        sim.say("hello")


def test_simulate_immediately_raises_the_faults_of_declarations() -> None:
    with pytest.raises(rs.DeclarationErrors):
        simulate(rs.Module("a"), rs.Module("a"))
    with pytest.raises(rs.DeclarationErrors):
        simulate(talk(), settings={"talk": {"greting": "x"}})


def test_an_exception_in_the_block_is_raised_after_everything_is_closed() -> None:
    module, go, _ = clock()
    told: list[str] = []

    @module.rule(when=go)
    async def long(ctx: rs.RuleContext) -> None:
        try:
            await ctx.sleep(3600)
        finally:
            told.append("cleaned up")

    @module.rule(when=rs.shutdown)
    async def end(ctx: rs.RuleContext) -> None:
        told.append("shut down")

    sim = simulate(module)
    with pytest.raises(ZeroDivisionError), sim:
        sim.emit(go)
        _ = 1 / 0
    assert told == ["shut down", "cleaned up"]
    del sim
    gc.collect()  # if its loop were still open, asyncio would warn, and the test would fail


def test_two_simulations_can_run_side_by_side() -> None:
    policy = rs.compile(talk())
    with simulate(policy) as one, simulate(policy) as other:
        one.say("x")
        one.advance(5)
        assert (one.now, other.now) == (5.0, 0.0)
        assert (one.said, other.said) == (["hello", "X"], ["hello"])
