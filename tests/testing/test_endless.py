"""Rules that could loop or wait without end: either an error names the loop, or the engine prevents it."""

import asyncio
import threading

import pytest

import ravestate as rs
from ravestate.testing import simulate


def test_the_error_names_the_rule_of_a_loop_without_a_minimum_age() -> None:
    m = rs.Module("m")
    a = m.signal("a")

    @m.rule(when=a, emits=a, detached=True)
    async def again(ctx: rs.RuleContext) -> None:
        ctx.emit(a)

    with pytest.raises(rs.EngineError, match=r"m:again.*min_age"), simulate(m, trace=False) as sim:
        sim.emit(a)


def test_a_rule_can_require_that_there_is_no_pressure_although_its_own_wait_raises_pressure() -> None:
    m = rs.Module("m")
    x, y, out = m.signal("x"), m.signal("y"), m.slot("out", "")

    @m.rule(when=x & rs.pressure.holds(lambda pressed: not pressed), writes=out)
    async def calm(ctx: rs.RuleContext) -> None:
        ctx[out] = "calm"

    @m.rule(when=x & y, writes=out, weight=3)
    async def both(ctx: rs.RuleContext) -> None:
        ctx[out] = "both"

    with simulate(m) as sim:
        sim.emit(x)
        sim.advance(1.0)
        assert sim.read(out) == "calm"


def test_a_failure_caused_by_an_apology_causes_no_second_apology() -> None:
    m = rs.Module("m")
    said = m.slot("said", "")
    go = m.signal("go")

    @m.rule(when=rs.error, writes=said)
    async def apologise(ctx: rs.RuleContext) -> None:
        ctx[said] = "Sorry."

    @m.rule(when=said.changed)
    async def speak(ctx: rs.RuleContext) -> None:
        raise rs.PlatformError("the loudspeaker is gone")

    @m.rule(when=go)
    async def fail(ctx: rs.RuleContext) -> None:
        raise ValueError("broken")

    with simulate(m) as sim:
        sim.emit(go)
        assert [rule for rule, _ in sim.failures] == ["m:fail", "m:speak"]


def test_more_spikes_do_not_delay_an_interruption_with_a_minimum_age() -> None:
    m = rs.Module("m")
    go, tick = m.signal("go"), m.signal("tick")

    @m.rule(when=go, until=tick.min_age(2.0))
    async def run(ctx: rs.RuleContext) -> None:
        await ctx.sleep(1_000.0)

    with simulate(m) as sim:
        sim.emit(go)
        for _ in range(4):
            sim.advance(0.5)
            sim.emit(tick)
        assert sim.fired == []
        sim.advance(0.5)
        assert sim.fired == ["m:run"]


def test_rules_that_plain_functions_add_at_the_same_time_are_all_kept() -> None:
    m, extra = rs.Module("m"), rs.Module("extra")
    go, heard = m.signal("go"), m.collection("heard")

    def rule_of(number: int) -> rs.Rule[..., object]:
        async def hear(ctx: rs.RuleContext) -> None:
            ctx[heard].add(str(number), True)

        return extra.rule(when=go, writes=heard, name=f"r{number}", detached=True)(hear)

    def adder(number: int) -> None:
        rule = rule_of(number)

        def add(ctx: rs.RuleContext) -> None:
            ctx.add_rule(rule)

        m.rule(when=rs.startup, name=f"add{number}")(add)

    for number in range(4):
        adder(number)

    async def main() -> int:
        async with rs.Context(m) as context:
            await context.quiet()
            return len(context.policy.rules)

    assert asyncio.run(main()) == 8


def test_the_default_of_a_slot_must_be_a_value_that_can_be_copied() -> None:
    m = rs.Module("m")
    m.slot("lock", threading.Lock())
    with pytest.raises(rs.DeclarationErrors) as caught:
        rs.compile(m)
    assert "rs.startup" in str(caught.value.exceptions[0])
