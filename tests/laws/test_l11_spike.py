"""L11: a spike is an occurrence with payload, time of birth and parents. It belongs to its parents' causal group."""

from typing import Any

import ravestate as rs
from laws.short import births, emitter, hearer, output, writer, written
from ravestate.engine.trace import Merged


def groups(sim: Any, *signals: rs.Signal[Any]) -> list[int]:
    """Return the causal group to which each signal's last spike belongs now."""
    into = {record.group: record.into for record in sim.trace if isinstance(record, Merged)}
    found: list[int] = []
    for signal in signals:
        group = births(sim, signal)[-1].group
        while group in into:
            group = into[group]
        found.append(group)
    return found


def test_a_spike_has_payload_time_and_parents(play: Any) -> None:
    m = rs.Module("m")
    i, x = m.signal("i"), m.signal("x")
    emitter(m, "cause", i, x, after=2.0)
    with play(m) as sim:
        sim.advance(1.0)
        sim.emit(i, "payload")
        sim.advance(5.0)
        [born], [child] = births(sim, i), births(sim, x)
        assert (born.time, born.payload, born.parents) == (1.0, "payload", ())
        assert (child.time, child.payload, child.parents) == (3.0, "cause", (born.spike,))


def test_a_spike_without_parents_begins_a_group(play: Any) -> None:
    m = rs.Module("m")
    i, j = m.signal("i"), m.signal("j")
    with play(m) as sim:
        sim.emit(i)
        sim.emit(j)
        sim.emit(i)
        begun = [born.group for born in (*births(sim, i), *births(sim, j))]
        assert len(set(begun)) == 3


def test_a_spike_belongs_to_the_group_of_its_parent(play: Any) -> None:
    m = rs.Module("m")
    i, x, text = m.signal("i"), m.signal("x"), m.slot("text", "")
    emitter(m, "cause", i, x)
    writer(m, "write", x, text)
    with play(m) as sim:
        sim.emit(i)
        assert len(set(groups(sim, i, x, text.changed))) == 1


def test_the_groups_of_several_parents_merge(play: Any) -> None:
    m = rs.Module("m")
    i, j, x, out = m.signal("i"), m.signal("j"), m.signal("x"), output(m)
    emitter(m, "fuse", i & j, x)
    writer(m, "act", x, out)
    writer(m, "late", j.min_age(1.0), out)
    with play(m) as sim:
        sim.emit(i)
        sim.emit(j)
        assert set(births(sim, x)[0].parents) == {births(sim, i)[0].spike, births(sim, j)[0].spike}
        assert len(set(groups(sim, i, j, x))) == 1
        sim.advance(10.0)
        # i, j and x are one group. In this group, `act` has written the slot, so `late` may not write it.
        assert written(sim, out) == ["act"]


def test_a_spike_that_is_emitted_detached_begins_a_group(play: Any) -> None:
    m = rs.Module("m")
    i, x, text = m.signal("i"), m.signal("x"), m.slot("text", "")
    emitter(m, "cause", i, x, detached=True)
    writer(m, "write", i, text, detached=True)
    with play(m) as sim:
        sim.emit(i)
        assert births(sim, x)[0].parents == births(sim, text.changed)[0].parents == ()
        assert len(set(groups(sim, i, x, text.changed))) == 3


def test_a_spike_seen_through_a_detached_constraint_is_not_a_parent(play: Any) -> None:
    m = rs.Module("m")
    i, j, x = m.signal("i"), m.signal("j"), m.signal("x")
    emitter(m, "cause", i & j.detached(), x)
    hearer(m, "hold", i & j & m.signal("never"), i, [])
    with play(m) as sim:
        sim.emit(i)
        sim.emit(j)
        assert births(sim, x)[0].parents == (births(sim, i)[0].spike,)
        assert groups(sim, x) == groups(sim, i) != groups(sim, j)


def test_the_signals_of_one_write_belong_to_one_group(play: Any) -> None:
    m = rs.Module("m")
    lit = m.flag("lit")
    with play(m) as sim:
        sim.put(lit, True)
        assert len(set(groups(sim, lit.changed, lit.true))) == 1
