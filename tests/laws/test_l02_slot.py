"""L2: slots are named, typed, long-lived variables, each with its own signals."""

from typing import Any

import pytest

import ravestate as rs
from laws.short import hearer, writer, written
from ravestate.engine.trace import Merged
from ravestate.testing import simulate


def heard_of(m: rs.Module, slot: rs.Slot[Any]) -> list[tuple[str, Any]]:
    """Declare a rule for each signal of a slot. Return the list to which each rule adds the signal and its payload."""
    heard: list[tuple[str, Any]] = []
    for signal in slot.signals:
        what = signal.name.rsplit(":", 1)[1]

        async def note(ctx: Any, signal: rs.Signal[Any] = signal, what: str = what) -> None:
            heard.append((what, ctx.payload(signal)))

        m.rule(when=signal, name=f"hear_{what}")(note)
    return heard


def test_every_slot_declares_its_signals() -> None:
    m = rs.Module("m")
    mood, lit, people = m.slot("mood", "calm"), m.flag("lit"), m.collection("people")
    assert mood.name == "m:mood"
    assert [s.name for s in mood.signals] == ["m:mood:changed"]
    assert {s.name for s in lit.signals} == {"m:lit:changed", "m:lit:true", "m:lit:false"}
    assert {s.name for s in people.signals} == {"m:people:added", "m:people:removed", "m:people:changed"}
    policy = rs.compile(m)
    assert policy.slots["m:mood"] is mood
    assert set(policy.signals) >= {s.name for slot in (mood, lit, people) for s in slot.signals}


def test_a_value_slot_signals_changed(play: Any) -> None:
    m = rs.Module("m")
    mood = m.slot("mood", "calm")
    heard = heard_of(m, mood)
    with play(m) as sim:
        assert sim.read(mood) == "calm"
        sim.put(mood, "merry")
        assert heard == [("changed", "merry")]
        assert sim.read(mood) == "merry"


def test_a_flag_signals_changed_and_its_new_value(play: Any) -> None:
    m = rs.Module("m")
    lit = m.flag("lit")
    heard = heard_of(m, lit)
    with play(m) as sim:
        assert sim.read(lit) is False
        sim.put(lit, True)
        assert sorted(heard) == [("changed", True), ("true", True)]
        heard.clear()
        sim.put(lit, False)
        assert sorted(heard) == [("changed", False), ("false", False)]


def test_a_collection_signals_added_and_removed_items(play: Any) -> None:
    m = rs.Module("m")
    people = m.collection("people")
    heard = heard_of(m, people)
    with play(m) as sim:
        assert dict(sim.read(people)) == {}
        sim.put(people, {"ann": 1})
        assert sorted(heard) == [("added", ("ann", 1)), ("changed", ("ann", 1))]
        heard.clear()
        sim.put(people, {"ann": 2})
        assert heard == [("changed", ("ann", 2))]
        heard.clear()
        sim.put(people, {"ann": 2, "bob": 3})
        assert sorted(heard) == [("added", ("bob", 3)), ("changed", ("bob", 3))]
        heard.clear()
        sim.put(people, {"bob": 3})
        assert sorted(heard) == [("changed", ("ann", 2)), ("removed", ("ann", 2))]
        assert isinstance(heard[0][1], rs.Entry)


def test_a_rule_adds_and_removes_items_of_a_collection() -> None:
    m = rs.Module("m")
    people, go, leave = m.collection("people"), m.signal("go"), m.signal("leave")
    heard, seen = heard_of(m, people), list[dict[str, Any]]()

    @m.rule(when=go, writes=people)
    async def enter(ctx: Any) -> None:
        ctx[people].add("ann", 1)
        ctx[people].add("ann", 1)
        seen.append(dict(ctx[people]))

    @m.rule(when=leave, writes=people)
    async def exit(ctx: Any) -> None:
        ctx[people].remove("nobody")
        ctx[people].remove("ann")
        seen.append(dict(ctx[people]))

    with simulate(m) as sim:
        sim.emit(go)
        assert sorted(heard) == [("added", ("ann", 1)), ("changed", ("ann", 1))]
        heard.clear()
        sim.emit(leave)
        assert sorted(heard) == [("changed", ("ann", 1)), ("removed", ("ann", 1))]
        assert seen == [{"ann": 1}, {}]
        assert not sim.failures


def test_writing_an_equal_value_signals_nothing(play: Any) -> None:
    m = rs.Module("m")
    mood, lit, people = m.slot("mood", "calm"), m.flag("lit"), m.collection("people")
    heard = [heard_of(m, mood), *[list[Any]()]]
    for slot, name in ((lit, "lit"), (people, "people")):
        for signal in slot.signals:
            hearer(m, f"{name}_{signal.name.rsplit(':', 1)[1]}", signal, signal, heard[1])
    with play(m) as sim:
        sim.put(mood, "calm")
        sim.put(lit, False)
        sim.put(people, {})
        assert heard == [[], []]
        sim.put(people, {"ann": [1]})
        heard[1].clear()
        sim.put(people, {"ann": [1]})
        assert heard == [[], []]


@pytest.mark.parametrize("how", ["add", "write", "remove"])
def test_writing_an_equal_item_merges_no_groups(how: str) -> None:
    m = rs.Module("m")
    a, b, out, people = m.signal("a"), m.signal("b"), m.slot("out", ""), m.collection("people")

    @m.rule(when=a & b, writes=people, weight=3)
    async def know(ctx: Any) -> None:
        match how:
            case "add":
                ctx[people].add("ann", [1])
            case "write":
                ctx[people] = {"ann": [1]}
            case _:
                ctx[people].remove("bob")

    writer(m, "answer_a", a, out)
    writer(m, "answer_b", b, out)
    with simulate(m) as sim:
        sim.put(people, {"ann": [1]})
        sim.emit(a)
        sim.emit(b)
        assert written(sim, out) == ["answer_a", "answer_b"]  # two causes, two answers
        assert not [record for record in sim.trace if isinstance(record, Merged)]
        assert sim.fired.count("m:know") == 1


def test_a_slot_with_always_signals_even_an_equal_value(play: Any) -> None:
    m = rs.Module("m")
    said = m.slot("said", "", always=True)
    heard = heard_of(m, said)
    with play(m) as sim:
        sim.put(said, "yes")
        sim.put(said, "yes")
        assert heard == [("changed", "yes"), ("changed", "yes")]


def test_a_value_outlives_its_signals(play: Any) -> None:
    m = rs.Module("m")
    mood = m.slot("mood", "calm")
    with play(m) as sim:
        sim.put(mood, "merry")
        sim.advance(1_000.0)
        assert sim.read(mood) == "merry"


def test_each_context_has_its_own_copy_of_a_default(play: Any) -> None:
    m = rs.Module("m")
    notes, go = m.slot("notes", list[str]()), m.signal("go")

    @m.rule(when=go, writes=notes)
    async def note(ctx: Any) -> None:
        ctx[notes].append("x")

    policy = rs.compile(m)
    for _ in range(2):
        with play(policy) as sim:
            sim.emit(go)
            assert sim.read(notes) == ["x"]
    assert notes.default == []


def test_a_slot_in_place_of_a_signal_is_refused() -> None:
    m = rs.Module("m")
    mood, go = m.slot("mood", "calm"), m.signal("go")
    with pytest.raises(rs.DeclarationError, match=r"\.changed"):
        _ = go & mood  # type: ignore[operator]
    with pytest.raises(rs.DeclarationError, match=r"mood\.changed"):
        hearer(m, "hear", mood, mood.changed, [])  # type: ignore[arg-type]
