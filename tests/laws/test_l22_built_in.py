"""L22: the built-in signals startup, shutdown and error, and the built-in flags activity and pressure."""

from typing import Any

import ravestate as rs
from laws.short import emitter, hearer, moments, output, writer


def test_startup_is_raised_once_when_a_context_begins(play: Any) -> None:
    m = rs.Module("m")
    out = output(m)
    writer(m, "greet", rs.startup, out)
    with play(m) as sim:
        sim.advance(10.0)
        assert moments(sim, out) == [(0.0, "greet")]


def test_shutdown_is_raised_once_when_a_context_ends(play: Any) -> None:
    m = rs.Module("m")
    out, heard = output(m), list[Any]()
    writer(m, "part", rs.shutdown, out)
    hearer(m, "hear", rs.shutdown, rs.shutdown, heard)
    with play(m) as sim:
        sim.advance(10.0)
        assert heard == []
    assert heard == [None]
    assert moments(sim, out) == [(10.0, "part")]


def test_error_carries_the_rule_and_the_exception(play: Any) -> None:
    m = rs.Module("m")
    i, errors, oops = m.signal("i"), list[Any](), ValueError("broken")

    @m.rule(when=i)
    async def fail(ctx: Any) -> None:
        raise oops

    hearer(m, "hear", rs.error, rs.error, errors)
    with play(m) as sim:
        sim.emit(i)
        assert errors == [rs.RuleFailure("m:fail", oops)]


def test_core_has_the_documented_signals_and_flags_and_no_rules() -> None:
    policy = rs.compile()
    assert list(policy.rules) == []
    assert set(policy.slots) == {"core:activity", "core:pressure"}
    assert {"core:startup", "core:shutdown", "core:error"} <= set(policy.signals)
    assert {"core:activity:true", "core:activity:false"} <= set(policy.signals)
    assert {"core:pressure:true", "core:pressure:false"} <= set(policy.signals)
    assert isinstance(rs.activity, rs.Flag)
    assert isinstance(rs.pressure, rs.Flag)


def test_activity_is_true_while_an_activation_holds_a_spike(play: Any) -> None:
    m = rs.Module("m")
    i, j = m.signal("i"), m.signal("j")
    hearer(m, "wait", i & j, i, [])
    with play(m) as sim:
        assert sim.read(rs.activity) is False
        sim.advance(1.0)
        sim.emit(i)
        assert sim.read(rs.activity) is True
        sim.advance(4.9)
        assert sim.read(rs.activity) is True
        sim.advance(5.0)
        assert sim.read(rs.activity) is False
        assert moments(sim, rs.activity) == [(1.0, True), (6.0, False)]


def test_activity_is_true_while_a_rule_runs(play: Any) -> None:
    m = rs.Module("m")
    i, out = m.signal("i"), output(m)
    writer(m, "slow", i, out, after=7.0)
    with play(m) as sim:
        sim.emit(i)
        sim.advance(20.0)
        assert moments(sim, rs.activity) == [(0.0, True), (7.0, False)]


def test_background_rules_do_not_count_as_activity(play: Any) -> None:
    m = rs.Module("m")
    i, j, out = m.signal("i"), m.signal("j"), output(m)
    writer(m, "slow", i, out, after=7.0, background=True)
    hearer(m, "wait", i & j, i, [], background=True)
    with play(m) as sim:
        sim.emit(i)
        assert sim.read(rs.activity) is False
        sim.advance(20.0)
        assert moments(sim, rs.activity) == []


def test_pressure_is_true_while_an_activation_is_kept_waiting(play: Any) -> None:
    m = rs.Module("m")
    i, x, out = m.signal("i"), m.signal("x"), output(m)
    emitter(m, "classify", i, x, after=2.0)
    writer(m, "specific", x, out)
    writer(m, "general", i, out)
    with play(m) as sim:
        assert sim.read(rs.pressure) is False
        sim.advance(1.0)
        sim.emit(i)
        assert sim.read(rs.pressure) is True
        sim.advance(20.0)
        assert sim.read(rs.pressure) is False
        assert moments(sim, rs.pressure) == [(1.0, True), (3.0, False)]


def test_an_activation_that_only_lacks_spikes_does_not_raise_pressure(play: Any) -> None:
    m = rs.Module("m")
    i, j, out = m.signal("i"), m.signal("j"), output(m)
    writer(m, "wait", i & j, out)
    with play(m) as sim:
        sim.emit(i)
        sim.advance(20.0)
        assert moments(sim, rs.pressure) == []


def test_a_bored_signal_can_be_built_from_activity(play: Any) -> None:
    m = rs.Module("m")
    i, bored, heard = m.signal("i"), m.signal("bored"), list[float]()
    hearer(m, "hear", i, i, [])

    @m.rule(when=rs.activity.false.min_age(5.0).max_age(None), emits=bored, detached=True, background=True)
    async def notice(ctx: Any) -> None:
        ctx.emit(bored)

    @m.rule(when=bored, background=True)
    async def note(ctx: Any) -> None:
        heard.append(ctx.now)

    with play(m) as sim:
        sim.emit(i)
        sim.advance(4.0)
        sim.emit(i)
        sim.advance(20.0)
        assert heard[0] == 9.0  # five seconds without activity after the last input


def test_an_impatient_signal_can_be_built_from_pressure(play: Any) -> None:
    m = rs.Module("m")
    i, x, impatient, out, heard = (
        m.signal("i"),
        m.signal("x"),
        m.signal("impatient"),
        output(m),
        list[float](),
    )
    emitter(m, "classify", i, x, after=3.0)
    writer(m, "specific", x, out)
    writer(m, "general", i, out)

    @m.rule(when=rs.pressure.true.min_age(1.0).max_age(None), emits=impatient, detached=True, background=True)
    async def notice(ctx: Any) -> None:
        ctx.emit(impatient)

    @m.rule(when=impatient, background=True)
    async def note(ctx: Any) -> None:
        heard.append(ctx.now)

    with play(m) as sim:
        sim.emit(i)
        sim.advance(20.0)
        assert heard == [1.0]
        assert moments(sim, out) == [(3.0, "specific")]
