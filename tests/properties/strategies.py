"""Hypothesis strategies for random worlds: small policies with many conflicts, and many simultaneous inputs."""

from __future__ import annotations

from functools import cache, lru_cache
from typing import Any

from hypothesis import assume
from hypothesis import strategies as st

from properties.worlds import Act, Clause, Gate, Op, RuleOf, SignalOf, SlotOf, Want, World, compiled
from ravestate.errors import DeclarationErrors

__all__ = ["worlds"]


@lru_cache(
    maxsize=None, typed=True
)  # Hypothesis checks each new strategy; without a cache, the checks take a third of the time
def pick(*values: Any) -> st.SearchStrategy[Any]:
    """Return a strategy for one of these values."""
    return st.sampled_from(values)


@lru_cache(maxsize=None, typed=True)
def just(value: Any) -> st.SearchStrategy[Any]:
    """Return a strategy for this value."""
    return st.just(value)


PAYLOADS = pick(1, 0, 2)
LATER = pick(0.0, 0.25, 0.5, 1.0, 2.0)
GAPS = pick(0.0, 0.0, 0.0, 0.25, 0.5, 1.0, 2.0, 5.0, 30.0)
SIGNALS = st.builds(
    SignalOf,
    keep=pick("all", "all", "all", "latest"),
    limit=pick(100, 100, 100, 1, 2),
    input=st.booleans(),
)
SLOTS = st.builds(
    SlotOf,
    kind=pick("value", "value", "flag", "collection"),
    always=st.booleans(),
    keep=pick("all", "all", "all", "latest"),
    limit=pick(100, 100, 100, 1, 2),
    input=st.booleans(),
)


def own_signals(slots: tuple[SlotOf, ...]) -> list[str]:
    """Return the names of the signals of these slots."""
    kinds = {
        "value": ("changed",),
        "flag": ("changed", "true", "false"),
        "collection": ("changed", "added", "removed"),
    }
    return [f"v{number}:{what}" for number, slot in enumerate(slots) for what in kinds[slot.kind]]


@cache
def writes(slots: tuple[SlotOf, ...], names: tuple[str, ...]) -> tuple[st.SearchStrategy[Op], ...]:
    """Return strategies for operations that write the slots with these names."""
    found: list[st.SearchStrategy[Op]] = []
    for name in names:
        kind = slots[int(name[1:])].kind
        if kind == "collection":
            keys = pick("a", "b")
            found += [
                st.tuples(just("store"), just(name), keys, PAYLOADS),
                st.tuples(just("discard"), just(name), keys),
                st.tuples(just("write"), just(name), pick((), (("a", 1),), (("b", 1), ("a", 2)))),
            ]
        else:
            values = st.booleans() if kind == "flag" else PAYLOADS
            found.append(st.tuples(just("write"), just(name), values))
    return tuple(found)


@st.composite
def wants(draw: st.DrawFn, signals: list[str], ageless: bool) -> Want:
    signal = draw(pick(*signals))
    if draw(pick(True, True, False)):
        return Want(signal)
    low = draw(pick(0.0, 0.0, 0.5, 1.0))
    highs = [5.0, 5.0, 1.0, 2.0]
    if ageless and not signal.startswith("core:"):
        highs.append(None)
    return Want(
        signal,
        low,
        draw(pick(*highs)),
        draw(pick(False, False, False, True)),
        draw(pick("", "", "", "", "odd", "odd", "fussy", "never")),
    )


@st.composite
def clauses(draw: st.DrawFn, signals: list[str], slots: tuple[SlotOf, ...], ageless: bool) -> tuple[Clause, ...]:
    found: list[Clause] = []
    for _ in range(draw(pick(1, 1, 1, 2))):
        parts: list[Any] = [draw(wants(signals, ageless)) for _ in range(draw(pick(1, 1, 1, 1, 2, 2, 3)))]
        if slots and draw(pick(False, False, False, True)):
            gate = draw(st.integers(0, len(slots) - 1))
            parts.append(Gate(f"v{gate}", draw(pick("odd", "odd", "fussy", "never"))))
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
        draw(pick("done", "done", "done", "resigned", "failed", "retired")),
        draw(pick(0.0, 0.0, 0.5)),
        tuple(last),
        draw(pick("done", "done", "resigned", "failed", "retired")),
    )


@st.composite
def rules(draw: st.DrawFn, signals: list[str], world: World, emitted: list[str], ageless: bool, core: bool) -> RuleOf:
    heard = signals
    background = draw(pick(False, False, False, True))
    if core and draw(pick(False, False, False, True)):
        flags = ["core:activity:true", "core:activity:false", "core:pressure:true", "core:pressure:false"]
        heard = [*signals, *flags, "core:error", "core:startup"]
        background = True  # otherwise, the rule would change the flag by holding a spike of it
    names = [f"v{n}" for n in range(len(world.slots))]
    written = draw(st.lists(pick(*names), unique=True, max_size=2)) if names else []
    emits = draw(st.lists(pick(*emitted), unique=True, max_size=2)) if emitted else []
    ops = [*writes(world.slots, tuple(written))]
    ops += [st.tuples(just("emit"), just(name), PAYLOADS) for name in emits]
    if draw(pick(*[False] * 7, True)):
        ops.append(st.tuples(just("wipe"), pick(*signals)))
    until: tuple[Clause, ...] = ()
    if draw(pick(False, False, False, True)):
        until = draw(clauses(signals, world.slots, False))
    return RuleOf(
        draw(clauses(heard, world.slots, ageless)),
        tuple(written),
        tuple(emits),
        tuple(draw(st.lists(acts(ops), min_size=1, max_size=2))),
        draw(pick(False, False, False, True)),
        background,
        draw(pick(False, False, False, True)),
        draw(pick(1.0, 1.0, 2.0, 0.5)),
        draw(pick(0.0, 0.0, 0.0, 2.0, 5.0)),
        draw(pick(None, None, 0.0, 0.5, 3.0)),
        until,
        draw(pick(None, None, None, 0.5, 1.0)),
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
    ops = [
        *writes(world.slots, tuple(f"v{n}" for n in range(len(world.slots)))),
        *[st.tuples(just("emit"), just(name), PAYLOADS) for name in named] * 2,
        st.tuples(just("wipe"), pick(*signals)),
        just(("start",)),
    ]
    if adds:
        ops.append(st.tuples(just("add"), rules(signals, world, named, ageless, core)))
    inputs = draw(st.lists(st.tuples(GAPS, st.one_of(*ops)), min_size=3, max_size=12))
    world = World(
        world.signals,
        world.slots,
        specs,
        tuple(inputs),
        draw(pick(1.0, 0.25, 2.0)),
        draw(st.booleans()),
        draw(st.sampled_from([1, 1, 2])),
    )
    try:
        compiled(world)
    except DeclarationErrors:
        assume(False)
    return world
