"""Random worlds: small policies full of collisions, with many inputs at once."""

from __future__ import annotations

from typing import Any

from hypothesis import assume
from hypothesis import strategies as st

from properties.worlds import Act, Clause, Gate, Op, RuleOf, SignalOf, SlotOf, Want, World, compiled
from ravestate.errors import DeclarationErrors

__all__ = ["worlds"]

PAYLOADS = st.sampled_from([1, 0, 2])
LATER = st.sampled_from([0.0, 0.25, 0.5, 1.0, 2.0])
GAPS = st.sampled_from([0.0, 0.0, 0.0, 0.25, 0.5, 1.0, 2.0, 5.0, 30.0])
SIGNALS = st.builds(
    SignalOf,
    keep=st.sampled_from(["all", "all", "all", "latest"]),
    limit=st.sampled_from([100, 100, 100, 1, 2]),
    input=st.booleans(),
)
SLOTS = st.builds(
    SlotOf,
    kind=st.sampled_from(["value", "value", "flag", "collection"]),
    always=st.booleans(),
    keep=st.sampled_from(["all", "all", "all", "latest"]),
    limit=st.sampled_from([100, 100, 100, 1, 2]),
    input=st.booleans(),
)


def own_signals(slots: tuple[SlotOf, ...]) -> list[str]:
    """Return the names of the signals of slots."""
    kinds = {
        "value": ("changed",),
        "flag": ("changed", "true", "false"),
        "collection": ("changed", "added", "removed"),
    }
    return [f"v{number}:{what}" for number, slot in enumerate(slots) for what in kinds[slot.kind]]


def writes(slots: tuple[SlotOf, ...], names: list[str]) -> list[st.SearchStrategy[Op]]:
    """Return ways to write the slots of these names."""
    found: list[st.SearchStrategy[Op]] = []
    for name in names:
        kind = slots[int(name[1:])].kind
        if kind == "collection":
            keys = st.sampled_from(["a", "b"])
            found += [
                st.tuples(st.just("store"), st.just(name), keys, PAYLOADS),
                st.tuples(st.just("discard"), st.just(name), keys),
                st.tuples(st.just("write"), st.just(name), st.sampled_from([(), (("a", 1),), (("b", 1), ("a", 2))])),
            ]
        else:
            values = st.booleans() if kind == "flag" else PAYLOADS
            found.append(st.tuples(st.just("write"), st.just(name), values))
    return found


@st.composite
def wants(draw: st.DrawFn, signals: list[str], ageless: bool) -> Want:
    signal = draw(st.sampled_from(signals))
    if draw(st.sampled_from([True, True, False])):
        return Want(signal)
    low = draw(st.sampled_from([0.0, 0.0, 0.5, 1.0]))
    highs = [5.0, 5.0, 1.0, 2.0]
    if ageless and not signal.startswith("core:"):
        highs.append(None)
    return Want(
        signal,
        low,
        draw(st.sampled_from(highs)),
        draw(st.sampled_from([False, False, False, True])),
        draw(st.sampled_from(["", "", "", "", "odd", "odd", "fussy", "never"])),
    )


@st.composite
def clauses(draw: st.DrawFn, signals: list[str], slots: tuple[SlotOf, ...], ageless: bool) -> tuple[Clause, ...]:
    found: list[Clause] = []
    for _ in range(draw(st.sampled_from([1, 1, 1, 2]))):
        parts: list[Any] = [draw(wants(signals, ageless)) for _ in range(draw(st.sampled_from([1, 1, 1, 1, 2, 2, 3])))]
        if slots and draw(st.sampled_from([False, False, False, True])):
            gate = draw(st.integers(0, len(slots) - 1))
            parts.append(Gate(f"v{gate}", draw(st.sampled_from(["odd", "odd", "fussy", "never"]))))
        found.append(tuple(parts))
    return tuple(found)


@st.composite
def acts(draw: st.DrawFn, ops: list[st.SearchStrategy[Op]]) -> Act:
    any_op = st.one_of(*ops) if ops else None
    steps: list[tuple[float, Op]] = []
    last: list[Op] = []
    if any_op is not None:
        steps = draw(st.lists(st.tuples(LATER, any_op), max_size=3))
        last = draw(st.one_of(st.just([]), st.lists(any_op, max_size=1)))
    return Act(
        tuple(steps),
        draw(LATER),
        draw(st.sampled_from(["done", "done", "done", "resigned", "failed", "retired"])),
        draw(st.sampled_from([0.0, 0.0, 0.5])),
        tuple(last),
        draw(st.sampled_from(["done", "done", "resigned", "failed", "retired"])),
    )


@st.composite
def rules(draw: st.DrawFn, signals: list[str], world: World, emitted: list[str], ageless: bool, core: bool) -> RuleOf:
    heard = signals
    background = draw(st.sampled_from([False, False, False, True]))
    if core and draw(st.sampled_from([False, False, False, True])):
        flags = ["core:activity:true", "core:activity:false", "core:pressure:true", "core:pressure:false"]
        heard = [*signals, *flags, "core:error", "core:startup"]
        background = True  # otherwise its own hold on the flag's spike would change the flag
    names = [f"v{n}" for n in range(len(world.slots))]
    written = draw(st.lists(st.sampled_from(names), unique=True, max_size=2)) if names else []
    emits = draw(st.lists(st.sampled_from(emitted), unique=True, max_size=2)) if emitted else []
    ops = writes(world.slots, written)
    ops += [st.tuples(st.just("emit"), st.just(name), PAYLOADS) for name in emits]
    if draw(st.sampled_from([False] * 7 + [True])):
        ops.append(st.tuples(st.just("wipe"), st.sampled_from(signals)))
    until: tuple[Clause, ...] = ()
    if draw(st.sampled_from([False, False, False, True])):
        until = draw(clauses(signals, world.slots, False))
    return RuleOf(
        draw(clauses(heard, world.slots, ageless)),
        tuple(written),
        tuple(emits),
        tuple(draw(st.lists(acts(ops), min_size=1, max_size=2))),
        draw(st.sampled_from([False, False, False, True])),
        background,
        draw(st.sampled_from([False, False, False, True])),
        draw(st.sampled_from([1.0, 1.0, 2.0, 0.5])),
        draw(st.sampled_from([0.0, 0.0, 0.0, 2.0, 5.0])),
        draw(st.sampled_from([None, None, 0.0, 0.5, 3.0])),
        until,
        draw(st.sampled_from([None, None, None, 0.5, 1.0])),
    )


@st.composite
def worlds(draw: st.DrawFn, *, ageless: bool = True, core: bool = True, adds: bool = False) -> World:
    """Generate worlds that compile.

    Args:
        ageless: Whether constraints may wait for ever (``max_age(None)``).
        core: Whether rules may hear the built-in signals.
        adds: Whether the inputs may add rules.
    """
    world = World(
        tuple(draw(st.lists(SIGNALS, min_size=1, max_size=3))),
        tuple(draw(st.lists(SLOTS, min_size=1, max_size=2))),
    )
    named = [f"s{n}" for n in range(len(world.signals))]
    signals = named + own_signals(world.slots)
    some = st.lists(rules(signals, world, named, ageless, core), min_size=2, max_size=6)
    specs = tuple(draw(some))
    ops = writes(world.slots, [f"v{n}" for n in range(len(world.slots))])
    ops = [
        *ops,
        *[st.tuples(st.just("emit"), st.just(name), PAYLOADS) for name in named] * 2,
        st.tuples(st.just("wipe"), st.sampled_from(signals)),
        st.just(("start",)),
    ]
    if adds:
        ops.append(st.tuples(st.just("add"), rules(signals, world, named, ageless, core)))
    inputs = draw(st.lists(st.tuples(GAPS, st.one_of(*ops)), min_size=3, max_size=12))
    world = World(
        world.signals,
        world.slots,
        specs,
        tuple(inputs),
        draw(st.sampled_from([1.0, 0.25, 2.0])),
        draw(st.booleans()),
    )
    try:
        compiled(world)
    except DeclarationErrors:
        assume(False)
    return world
