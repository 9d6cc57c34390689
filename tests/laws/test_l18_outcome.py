"""L18: a run ends as Done, Resign, Error or Retire. Each outcome has effects on slots and spikes."""

import logging
from typing import Any

import pytest

import ravestate as rs
from laws.short import given_up, hearer, moments, outcomes, output, resigner, started, writer, written
from ravestate.engine.trace import Settled
from ravestate.testing import simulate


def two(act: Any, **options: Any) -> tuple[rs.Module, rs.Signal[Any], rs.Slot[str], list[rs.RuleFailure]]:
    """Declare `act`, the next best rule for the same slot, and a listener of `core:error`."""
    m = rs.Module("m")
    i, out, errors = m.signal("i"), output(m), list[rs.RuleFailure]()

    async def function(ctx: Any) -> object:
        return await act(ctx, out)

    m.rule(when=i, writes=out, name="act", **options)(function)
    writer(m, "next_best", i, out)
    hearer(m, "hear_error", rs.error, rs.error, errors)
    return m, i, out, errors


# ---------------------------------------------------------------------------------------- done


def test_the_outcome_done_consumes_the_slots(play: Any) -> None:
    async def act(ctx: Any, out: Any) -> None:
        ctx[out] = "act"

    m, i, out, errors = two(act)
    with play(m) as sim:
        sim.emit(i)
        sim.advance(10.0)
        assert written(sim, out) == ["act"]
        assert outcomes(sim) == [("act", "done")]
        assert given_up(sim, "next_best") == [(0.0, "i", "consumed")]
        assert errors == []


def test_the_outcome_done_consumes_the_slots_even_if_nothing_was_written(play: Any) -> None:
    async def act(ctx: Any, out: Any) -> None: ...

    m, i, out, _ = two(act)
    with play(m) as sim:
        sim.emit(i)
        sim.advance(10.0)
        assert (written(sim, out), sim.fired) == ([], ["m:act"])


def test_the_outcome_done_leaves_the_spikes_for_other_slots(play: Any) -> None:
    m = rs.Module("m")
    i, j, out, face = m.signal("i"), m.signal("j"), output(m), output(m, "face")
    writer(m, "other", m.signal("k"), output(m, "arm"))
    writer(m, "speak", i, out)
    writer(m, "smile", i & j, face)
    writer(m, "answer", i & j, out, weight=0.01)
    writer(m, "perform", i & j, out, face, weight=0.01)
    with play(m) as sim:
        sim.emit(i)
        sim.advance(2.0)
        sim.emit(j)
        sim.advance(10.0)
        assert moments(sim, out) == [(0.0, "speak")]
        assert moments(sim, face) == [(2.0, "smile")]


# ---------------------------------------------------------------------------------------- resign


@pytest.mark.parametrize("raised", [False, True], ids=["returned", "raised"])
def test_after_a_rule_resigns_the_next_best_rule_is_asked(play: Any, raised: bool) -> None:
    async def act(ctx: Any, out: Any) -> rs.Resign:
        await ctx.sleep(2.0)
        if raised:
            raise rs.Resign("no idea")
        return rs.Resign("no idea")

    m, i, out, errors = two(act)
    with play(m) as sim:
        sim.emit(i)
        sim.advance(10.0)
        assert moments(sim, out) == [(2.0, "next_best")]
        assert outcomes(sim) == [("act", "resigned"), ("next_best", "done")]
        assert sim.fired == ["m:next_best"]
        assert errors == []
        settled = next(record for record in sim.trace if isinstance(record, Settled))
        assert (settled.reason, settled.fired) == ("no idea", False)


def test_a_rule_that_resigned_gives_up_these_spikes(play: Any) -> None:
    m = rs.Module("m")
    i, j, out = m.signal("i"), m.signal("j"), output(m)
    resigner(m, "shy", i & j, out)
    with play(m) as sim:
        sim.emit(i)
        sim.emit(j)
        assert outcomes(sim) == [("shy", "resigned")]
        sim.emit(i)  # the rule had also given up the earlier j
        assert outcomes(sim) == [("shy", "resigned")]
        sim.emit(j)
        assert outcomes(sim) == [("shy", "resigned")] * 2


def test_rules_resign_one_after_the_other(play: Any) -> None:
    m = rs.Module("m")
    i, out = m.signal("i"), output(m)
    for name in ("first", "second", "third"):
        resigner(m, name, i, out, after=1.0)
    writer(m, "last", i, out)
    with play(m) as sim:
        sim.emit(i)
        sim.advance(10.0)
        assert started(sim) == [(0.0, "first"), (1.0, "second"), (2.0, "third"), (3.0, "last")]


# ---------------------------------------------------------------------------------------- error


class Oops(Exception):
    pass


def test_an_exception_raises_the_error_signal_and_the_next_best_rule_runs(play: Any) -> None:
    async def act(ctx: Any, out: Any) -> None:
        raise Oops("broken")

    m, i, out, errors = two(act)
    with play(m) as sim:
        sim.emit(i)
        assert written(sim, out) == ["next_best"]
        assert outcomes(sim)[0] == ("act", "failed")
        [(rule, exception)] = sim.failures
        assert (rule, str(exception)) == ("m:act", "broken")
        [failure] = errors
        assert (failure.rule, failure.exception) == (rule, exception)


def test_a_rule_that_fails_after_it_has_written_is_done(play: Any) -> None:
    async def act(ctx: Any, out: Any) -> None:
        ctx[out] = "half a sen"
        raise Oops("broken")

    m, i, out, errors = two(act)
    with play(m) as sim:
        sim.emit(i)
        sim.advance(10.0)
        assert written(sim, out) == ["half a sen"]
        assert [failure.rule for failure in errors] == ["m:act"]
        assert "m:act" in sim.fired


def test_resigning_after_a_write_is_an_error(play: Any) -> None:
    async def act(ctx: Any, out: Any) -> rs.Resign:
        ctx[out] = "half a sen"
        return rs.Resign("too late")

    m, i, out, errors = two(act)
    with play(m) as sim:
        sim.emit(i)
        sim.advance(10.0)
        assert written(sim, out) == ["half a sen"]
        [failure] = errors
        assert isinstance(failure.exception, rs.RuleError)
        assert "m:act" in str(failure.exception)
        assert "m:out" in str(failure.exception)


@pytest.mark.parametrize("wrote", [False, True])
def test_a_time_out_is_an_error(play: Any, wrote: bool) -> None:
    cleaned: list[float] = []

    async def act(ctx: Any, out: Any) -> None:
        if wrote:
            ctx[out] = "well"
        try:
            await ctx.sleep(100.0)
        finally:
            cleaned.append(ctx.now)

    m, i, out, errors = two(act, timeout=3.0)
    with play(m) as sim:
        sim.emit(i)
        sim.advance(10.0)
        assert moments(sim, out) == [(0.0, "well")] if wrote else [(3.0, "next_best")]
        assert cleaned == [3.0]
        [failure] = errors
        assert (failure.rule, type(failure.exception)) == ("m:act", rs.RuleTimeout)
        assert "3 s" in str(failure.exception)


def test_a_rule_that_ends_in_time_is_not_timed_out(play: Any) -> None:
    async def act(ctx: Any, out: Any) -> None:
        await ctx.sleep(2.9)
        ctx[out] = "act"

    m, i, out, errors = two(act, timeout=3.0)
    with play(m) as sim:
        sim.emit(i)
        sim.advance(10.0)
        assert (moments(sim, out), errors) == ([(2.9, "act")], [])


def test_an_undeclared_access_is_an_error() -> None:
    async def act(ctx: Any, out: Any) -> None:
        ctx[other] = 1

    m, i, out, errors = two(act)
    other = m.slot("other", 0)
    with simulate(m) as sim:
        sim.emit(i)
        assert written(sim, out) == ["next_best"]
        assert [type(failure.exception) for failure in errors] == [rs.UndeclaredError]


@pytest.mark.parametrize("nonsense", [42, "text", False, [rs.Resign("in a list")]], ids=repr)
def test_a_returned_value_that_is_not_an_outcome_is_an_error(play: Any, nonsense: object) -> None:
    async def act(ctx: Any, out: Any) -> object:
        return nonsense

    m, i, out, errors = two(act)
    with play(m) as sim:
        sim.emit(i)
        assert written(sim, out) == ["next_best"]
        assert [type(failure.exception) for failure in errors] == [rs.RuleError]


def test_a_failure_is_logged_once_with_its_traceback(caplog: pytest.LogCaptureFixture) -> None:
    async def act(ctx: Any, out: Any) -> None:
        raise Oops("broken")

    m, i, _, _ = two(act)
    with caplog.at_level(logging.DEBUG), simulate(m) as sim:
        sim.emit(i)
        sim.advance(10.0)
    [record] = [record for record in caplog.records if record.levelno >= logging.WARNING]
    assert "m:act" in record.getMessage()
    assert record.exc_info is not None
    assert record.exc_info[0] is Oops
    assert record.exc_info[2] is not None


def test_an_error_handler_that_fails_is_not_called_for_its_own_failure(play: Any) -> None:
    async def act(ctx: Any, out: Any) -> None:
        raise Oops("broken")

    m, i, _, _ = two(act)

    @m.rule(when=rs.error)
    async def report(ctx: Any) -> None:
        raise Oops("broken as well")

    with play(m) as sim:
        sim.emit(i)
        sim.advance(10.0)
        assert [rule for rule, _ in sim.failures] == ["m:act", "m:report"]


# ---------------------------------------------------------------------------------------- retire


@pytest.mark.parametrize("raised", [False, True], ids=["returned", "raised"])
def test_a_rule_that_retires_in_one_context_still_runs_in_another(play: Any, raised: bool) -> None:
    async def act(ctx: Any, out: Any) -> rs.Retire:
        ctx[out] = "once"
        if raised:
            raise rs.Retire("enough")
        return rs.Retire("enough")

    m, i, out, errors = two(act)
    policy = rs.compile(m)
    with play(policy) as sim:
        for _ in range(3):
            sim.emit(i)
            sim.advance(1.0)
        assert moments(sim, out) == [(0.0, "once"), (1.0, "next_best"), (2.0, "next_best")]
        assert sim.snapshot()["retired"] == ["m:act"]
        assert errors == []
    with play(policy) as other:
        other.emit(i)
        assert written(other, out) == ["once"]


def test_a_retired_rule_gives_its_spikes_up(play: Any) -> None:
    m = rs.Module("m")
    i, j, out = m.signal("i"), m.signal("j"), output(m)

    @m.rule(when=i & j, writes=out)
    async def once(ctx: Any) -> rs.Retire:
        ctx[out] = "once"
        return rs.Retire()

    with play(m) as sim:
        sim.emit(i)
        sim.emit(i)
        sim.emit(j)
        assert sim.snapshot()["activations"] == []
