"""L13: a rule sees slots as they stood when it started, plus its own writes, which take effect immediately."""

from typing import Any

import ravestate as rs
from laws.short import hearer, moments, output, writer


def test_a_rule_sees_slots_as_they_stood_when_it_started(play: Any) -> None:
    m = rs.Module("m")
    go, mood, seen = m.signal("go"), m.slot("mood", "calm"), list[Any]()

    @m.rule(when=go, reads=mood)
    async def look(ctx: Any) -> None:
        seen.append(ctx[mood])
        await ctx.sleep(2.0)
        seen.append(ctx[mood])

    with play(m) as sim:
        sim.emit(go)
        sim.advance(1.0)
        sim.put(mood, "merry")
        sim.advance(1.0)
        assert seen == ["calm", "calm"]
        sim.emit(go)
        assert seen == ["calm", "calm", "merry"]


def test_a_rule_sees_its_own_writes(play: Any) -> None:
    m = rs.Module("m")
    go, mood, seen = m.signal("go"), m.slot("mood", "calm"), list[Any]()

    @m.rule(when=go, writes=mood)
    async def change(ctx: Any) -> None:
        seen.append(ctx[mood])
        ctx[mood] = "merry"
        seen.append(ctx[mood])
        await ctx.sleep(2.0)
        seen.append(ctx[mood])

    with play(m) as sim:
        sim.emit(go)
        sim.advance(1.0)
        sim.put(mood, "sad")
        sim.advance(1.0)
        assert seen == ["calm", "merry", "merry"]
        assert sim.read(mood) == "sad"


def test_a_write_takes_effect_and_signals_immediately(play: Any) -> None:
    m = rs.Module("m")
    go, mood, out = m.signal("go"), m.slot("mood", "calm"), output(m)

    @m.rule(when=go, writes=mood)
    async def change(ctx: Any) -> None:
        await ctx.sleep(1.0)
        ctx[mood] = "merry"
        await ctx.sleep(10.0)

    writer(m, "react", mood.changed, out)
    with play(m) as sim:
        sim.emit(go)
        sim.advance(1.0)
        assert sim.read(mood) == "merry"
        assert moments(sim, out) == [(1.0, "react")]
        assert sim.fired == ["m:react"]  # while `change` still runs


def test_an_emitted_signal_occurs_immediately(play: Any) -> None:
    m = rs.Module("m")
    go, x, heard = m.signal("go"), m.signal("x"), list[Any]()

    @m.rule(when=go, emits=x)
    async def cause(ctx: Any) -> None:
        ctx.emit(x, 1)
        await ctx.sleep(10.0)
        ctx.emit(x, 2)

    hearer(m, "hear", x, x, heard)
    with play(m) as sim:
        sim.emit(go)
        assert heard == [1]
        sim.advance(10.0)
        assert heard == [1, 2]


def test_a_rule_that_starts_later_sees_earlier_writes(play: Any) -> None:
    m = rs.Module("m")
    go, mood, seen = m.signal("go"), m.slot("mood", "calm"), list[Any]()
    writer(m, "merry", go, mood)

    @m.rule(when=mood.changed, reads=mood)
    async def look(ctx: Any) -> None:
        seen.append((ctx[mood], ctx.payload(mood.changed)))

    with play(m) as sim:
        sim.emit(go)
        assert seen == [("merry", "merry")]


def test_a_rule_sees_a_collection_as_it_stood_when_the_rule_started(play: Any) -> None:
    m = rs.Module("m")
    go, people, seen = m.signal("go"), m.collection("people"), list[Any]()

    @m.rule(when=go, reads=people)
    async def look(ctx: Any) -> None:
        await ctx.sleep(2.0)
        seen.append(dict(ctx[people]))

    with play(m) as sim:
        sim.put(people, {"ann": 1})
        sim.emit(go)
        sim.put(people, {"bob": 2})
        sim.advance(2.0)
        assert seen == [{"ann": 1}]
