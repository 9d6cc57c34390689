"""``ctx.origin``: a rule learns from which event of the world its run, or the output that it shows, comes."""

import asyncio
from typing import Any

import ravestate as rs
from laws.short import emitter, writer
from ravestate.engine.engine import Engine
from ravestate.runtime.journal import Journal, replay
from ravestate.testing import simulate


def shown(m: rs.Module, slot: rs.Slot[Any]) -> list[tuple[Any, Any]]:
    """Declare a platform's rule for a slot. Return the list of the slot's values with their origins."""
    found: list[tuple[Any, Any]] = []

    @m.rule(when=slot.changed.max_age(None).detached())
    async def show(ctx: rs.RuleContext) -> None:
        found.append((ctx.payload(slot.changed), ctx.origin))

    return found


def test_outputs_that_overtake_each_other_keep_the_origins_of_their_inputs() -> None:
    m = rs.Module("m")
    heard, said = m.slot("heard", "", always=True, input=True), m.slot("said", "", always=True)
    found = shown(m, said)

    @m.rule(when=heard.changed, writes=said)
    async def answer(ctx: rs.RuleContext) -> None:
        if ctx.payload(heard.changed) == "slow":
            await ctx.sleep(5.0)
        ctx[said] = ctx.payload(heard.changed)
        await ctx.sleep(5.0)
        ctx[said] = "more"

    with simulate(m) as sim:
        sim.context.put(heard, "slow", origin=1)
        sim.advance(2.0)
        sim.context.put(heard, "quick", origin=2)
        sim.advance(20.0)
        assert found == [("quick", 2), ("slow", 1), ("more", 2), ("more", 1)]


def test_an_origin_passes_through_rules_and_detached_rules_and_the_own_initiative_has_none() -> None:
    m = rs.Module("m")
    asked, understood, felt = m.signal("asked", input=True), m.signal("understood"), m.signal("felt")
    said = m.slot("said", "", always=True)
    found = shown(m, said)
    emitter(m, "understand", asked, understood, after=1.0)
    emitter(m, "feel", understood.detached(), felt, detached=True)
    writer(m, "answer", felt, said)
    writer(m, "begin", rs.startup, said)
    with simulate(m) as sim:
        sim.advance(1.0)
        sim.context.emit(asked, origin="letter")
        sim.advance(5.0)
        assert found == [("begin", None), ("answer", "letter")]


def test_of_several_origins_the_youngest_counts_but_those_of_detached_constraints_count_last() -> None:
    m = rs.Module("m")
    a, b, c = (m.signal(name, input=True) for name in "abc")
    said = m.slot("said", "", always=True)
    found = shown(m, said)
    writer(m, "join", a.max_age(None) & b.max_age(None), said)
    writer(m, "look", c & b.detached(), said)
    with simulate(m) as sim:
        sim.context.emit(b, origin="b")
        sim.context.emit(a, origin="a")
        sim.advance(1.0)
        sim.context.emit(c, origin="c")
        sim.context.emit(b, origin="second b")
        sim.advance(1.0)
        sim.context.emit(c)
        sim.advance(1.0)
    assert found == [("join", "a"), ("look", "c"), ("look", "second b")]


def test_each_change_of_a_collection_has_the_origin_of_its_write() -> None:
    m = rs.Module("m")
    users = m.collection("users", input=True)
    found: list[tuple[str, object]] = []

    @m.rule(when=users.added)
    async def greet(ctx: rs.RuleContext) -> None:
        found.append((ctx.payload(users.added).key, ctx.origin))

    with simulate(m) as sim:
        sim.context.put(users, {"ann": 1, "ben": 2}, origin="door")
        sim.context.put(users, {"ann": 1, "ben": 2, "cem": 3})
        sim.advance(0.0)
    assert found == [("ann", "door"), ("ben", "door"), ("cem", None)]


def test_an_error_has_the_origin_of_the_run_that_failed() -> None:
    m = rs.Module("m")
    asked, said = m.signal("asked", payload=str, input=True), m.slot("said", "", always=True)
    found = shown(m, said)

    @m.rule(when=asked)
    async def fail(ctx: rs.RuleContext) -> None:
        await ctx.sleep(5.0)
        raise ValueError(ctx.payload(asked))

    @m.rule(when=asked.detached(), timeout=2.0)
    async def dawdle(ctx: rs.RuleContext) -> None:
        await ctx.sleep(60.0)

    @m.rule(when=rs.error.max_age(None).detached(), writes=said, detached=True)
    async def excuse(ctx: rs.RuleContext) -> None:
        ctx[said] = ctx.payload(rs.error).rule

    with simulate(m) as sim:
        sim.context.emit(asked, "one", origin=1)
        sim.advance(1.0)
        sim.context.emit(asked, "two")
        sim.advance(20.0)
        sim.context.emit(asked, "three", origin=3)
        sim.advance(20.0)
        origins = {rule: [origin for name, origin in found if name == rule] for rule in ("m:fail", "m:dawdle")}
        assert origins == {"m:fail": [1, None, 3], "m:dawdle": [1, None, 3]}


def test_a_journal_keeps_the_origins() -> None:
    m = rs.Module("m")
    heard, said = m.slot("heard", "", input=True), m.slot("said", "")
    found = shown(m, said)
    writer(m, "answer", heard.changed, said)
    journal = Journal()

    async def talk() -> None:
        async with rs.Context(m, journal=journal) as context:
            context.put(heard, "hello", origin=7)
            await context.next(said.changed)

    asyncio.run(talk())
    assert found == [("answer", 7)]
    effects = [effect for effects in replay(Engine(rs.compile(m)), journal.entries) for effect in effects]
    assert 7 in [getattr(effect, "origin", None) for effect in effects]
