"""L3: a rule is an annotated function. It can use only what it has declared."""

import inspect
from typing import Any

import pytest

import ravestate as rs
from laws.short import hearer, output, writer
from ravestate.testing import Simulation, simulate


def test_a_declared_rule_can_still_be_called_as_a_function() -> None:
    m = rs.Module("m")
    go, mood, done = m.signal("go"), m.slot("mood", ""), m.signal("done")

    @m.rule(
        when=go, reads=mood, writes=(mood,), emits=[done], detached=True, weight=2.0, cooldown=3.0, patience=4.0,
        until=done, timeout=5.0, background=True,
    )  # fmt: skip
    def double(number: int) -> int:
        return 2 * number

    assert double.name == "m:double"
    assert double(21) == 42
    assert (double.reads, double.writes, double.emits) == ((mood,), (mood,), (done,))
    assert (double.detached, double.background) == (True, True)
    assert (double.weight, double.cooldown, double.patience, double.timeout) == (2.0, 3.0, 4.0, 5.0)
    assert m.rules == [double]


def test_a_condition_is_a_boolean_combination(play: Any) -> None:
    m = rs.Module("m")
    a, b, c = m.signal("a"), m.signal("b"), m.signal("c")
    heard: list[Any] = []
    hearer(m, "hear", (a & b) | c, c, heard)
    with play(m) as sim:
        sim.emit(a)
        assert heard == []
        sim.emit(b)
        assert heard == [None]
        sim.emit(c, 1)
        assert heard == [None, 1]
    with pytest.raises(rs.DeclarationError, match="&"):
        _ = a and b


def refused(m: rs.Module, go: rs.Signal[Any]) -> tuple[Simulation, str]:
    """Check that a forbidden access ends the run of `m:meddle` with an error, and that `rs.error` reports it (L18).

    Return the simulation and the error's message.
    """
    errors: list[rs.RuleFailure] = []
    hearer(m, "hear_error", rs.error, rs.error, errors)
    with simulate(m) as sim:
        sim.emit(go)
        [(rule, exception)] = sim.failures
    assert rule == "m:meddle"
    assert isinstance(exception, rs.UndeclaredError)
    assert [(failure.rule, failure.exception) for failure in errors] == [(rule, exception)]
    assert "m:meddle" in str(exception)
    assert f"{inspect.getsourcefile(refused)}:" in str(exception)  # where the rule was declared
    return sim, str(exception)


def test_an_undeclared_read_is_refused() -> None:
    m = rs.Module("m")
    go, secret = m.signal("go"), m.slot("secret", "treasure")
    seen: list[Any] = []

    @m.rule(when=go)
    async def meddle(ctx: rs.RuleContext) -> None:
        seen.append(ctx[secret])

    _, message = refused(m, go)
    assert seen == []
    assert "m:secret" in message
    assert "reads=" in message


def test_an_undeclared_write_is_refused() -> None:
    m = rs.Module("m")
    go, secret, heard = m.signal("go"), m.slot("secret", "treasure"), list[Any]()
    hearer(m, "hear", secret.changed, secret.changed, heard)

    @m.rule(when=go, reads=secret)
    async def meddle(ctx: rs.RuleContext) -> None:
        ctx[secret] = "stolen"

    sim, message = refused(m, go)
    assert sim.read(secret) == "treasure"
    assert heard == []
    assert "m:secret" in message
    assert "writes=" in message


def test_an_undeclared_change_of_a_collection_is_refused() -> None:
    m = rs.Module("m")
    go, people = m.signal("go"), m.collection("people")

    @m.rule(when=go, reads=people)
    async def meddle(ctx: rs.RuleContext) -> None:
        ctx[people].add("ann", 1)

    sim, message = refused(m, go)
    assert dict(sim.read(people)) == {}
    assert "m:people" in message
    assert "writes=" in message


def test_an_undeclared_emit_is_refused() -> None:
    m = rs.Module("m")
    go, alarm, heard = m.signal("go"), m.signal("alarm"), list[Any]()
    hearer(m, "hear", alarm, alarm, heard)

    @m.rule(when=go)
    async def meddle(ctx: rs.RuleContext) -> None:
        ctx.emit(alarm)

    _, message = refused(m, go)
    assert heard == []
    assert "m:alarm" in message
    assert "emits=" in message


def test_a_payload_that_the_condition_does_not_name_is_refused() -> None:
    m = rs.Module("m")
    go, other = m.signal("go"), m.signal("other")

    @m.rule(when=go)
    async def meddle(ctx: rs.RuleContext) -> None:
        ctx.payload(other)

    _, message = refused(m, go)
    assert "m:other" in message


def test_a_declared_access_is_allowed() -> None:
    m = rs.Module("m")
    go, mood, face, done = m.signal("go"), m.slot("mood", "calm"), output(m, "face"), m.signal("done")
    heard: list[Any] = []
    hearer(m, "hear", done, done, heard)

    @m.rule(when=go, reads=mood, writes=face, emits=done)
    async def act(ctx: rs.RuleContext) -> None:
        ctx[face] = ctx[mood] + ctx[face]
        ctx.emit(done, ctx[face])

    with simulate(m) as sim:
        sim.emit(go)
        assert sim.failures == []
        assert (sim.read(face), heard) == ("calm", ["calm"])


def test_rules_of_two_modules_can_have_the_same_name(play: Any) -> None:
    one, two = rs.Module("one"), rs.Module("two")
    go = one.signal("go")
    two.requires.append(one)
    left, right = one.slot("left", ""), two.slot("right", "")
    writer(one, "act", go, left)
    writer(two, "act", go, right)
    with play(one, two) as sim:
        sim.emit(go)
        assert sim.fired == ["one:act", "two:act"]
