"""L23: every signal has an overflow policy; when everything has settled and aged, nothing is left."""

import gc
from collections import Counter
from typing import Any

import pytest

import ravestate as rs
from laws.short import at_rest, drops, hearer, output, writer, written
from laws.story import everything, tell
from scenarios.driver import Driver


def test_beyond_the_limit_the_oldest_is_dropped_counted_and_traced(play: Any) -> None:
    m = rs.Module("m")
    a, b, heard = m.signal("a", payload=int, limit=3), m.signal("b"), list[Any]()
    hearer(m, "pair", a & b, a, heard)
    with play(m) as sim:
        for number in range(5):
            sim.emit(a, number)
        assert len(sim.snapshot()["spikes"]) == 3
        assert sim.snapshot()["dropped"] == {"m:a": 2}
        assert len(drops(sim, a)) == 2
        for _ in range(5):
            sim.emit(b)
        assert heard == [2, 3, 4]


def test_up_to_the_limit_all_are_kept(play: Any) -> None:
    m = rs.Module("m")
    a, b, heard = m.signal("a", payload=int, limit=3), m.signal("b"), list[Any]()
    hearer(m, "pair", a & b, a, heard)
    with play(m) as sim:
        for number in range(3):
            sim.emit(a, number)
        assert sim.snapshot()["dropped"] == {}
        for _ in range(3):
            sim.emit(b)
        assert heard == [0, 1, 2]


def test_the_limit_counts_live_spikes_only(play: Any) -> None:
    m = rs.Module("m")
    a, heard = m.signal("a", payload=int, limit=1), list[Any]()
    hearer(m, "hear", a, a, heard)
    with play(m) as sim:
        for number in range(10):
            sim.emit(a, number)
        assert heard == list(range(10))
        assert sim.snapshot()["dropped"] == {}


def test_keep_latest_keeps_one(play: Any) -> None:
    m = rs.Module("m")
    a, b, heard = m.signal("a", payload=int, keep="latest"), m.signal("b"), list[Any]()
    hearer(m, "pair", a & b, a, heard)
    with play(m) as sim:
        for number in range(5):
            sim.emit(a, number)
        assert [spike["payload"] for spike in sim.snapshot()["spikes"] if spike["signal"] == "m:a"] == [4]
        assert len(drops(sim, a)) == 4


def test_every_signal_has_a_limit() -> None:
    m = rs.Module("m")
    m.slot("text", "")
    m.collection("people", limit=7)
    assert [signal.limit for signal in m.slots[1].signals] == [7, 7, 7]
    assert all(signal.limit >= 1 for signal in (*m.slots[0].signals, rs.startup, *rs.activity.signals))
    with pytest.raises(rs.DeclarationError, match="limit=0"):
        m.signal("none", limit=0)
    with pytest.raises(rs.DeclarationError, match="'first'"):
        m.signal("none", keep="first")  # type: ignore[arg-type]


def census() -> Counter[str]:
    """The live objects of the engine, by kind."""
    gc.collect()
    kinds = (type(one) for one in gc.get_objects())
    return Counter(k.__qualname__ for k in kinds if str(k.__module__).startswith("ravestate.engine"))


def test_when_all_has_settled_and_aged_nothing_is_left(play: Any) -> None:
    with play(everything()) as sim:
        tell(sim)
        assert not at_rest(sim)
        sim.advance(60.0)
        assert at_rest(sim)
        assert sim.read(rs.activity) is False
        assert sim.read(rs.pressure) is False


def test_live_objects_return_to_their_number_at_rest() -> None:
    with Driver(everything(), trace=False) as sim:
        counts: list[Counter[str]] = []
        for _ in range(3):
            tell(sim)
            sim.advance(60.0)
            sim.failures.clear()
            sim.log.clear()
            sim.effects.clear()
            counts.append(census())
        assert counts[0] == counts[1] == counts[2]
        assert not {"Spike", "Activation", "Group", "Watch"} & set(counts[0])


def test_what_is_forgotten_early_leaves_nothing_behind(play: Any) -> None:
    m = rs.Module("m")
    a, b, out = m.signal("a"), m.signal("b"), output(m)
    writer(m, "both", a.max_age(None) & b, out)
    with play(m) as sim:
        for _ in range(50):
            sim.emit(a)
        sim.advance(1_000.0)
        assert len(sim.snapshot()["spikes"]) == 50  # for ever is for ever
        sim.wipe(a)
        assert at_rest(sim)
        assert written(sim, out) == []
