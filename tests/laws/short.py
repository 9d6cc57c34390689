"""Helpers that declare simple rules, and read the contents of a trace."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import ravestate as rs
from ravestate.engine.trace import Born, Dropped, GaveUp, Pressed, Set, Settled, Started


def output(module: rs.Module, name: str = "out") -> rs.Slot[str]:
    """Declare a slot that also signals a write of an equal value."""
    return module.slot(name, "", always=True)


def writer(
    module: rs.Module, name: str, when: rs.Condition, *slots: rs.Slot[Any], after: float = 0.0, **options: Any
) -> rs.Rule[Any, Any]:
    """Declare a rule that waits `after` seconds, and then writes its own name into its slots."""

    async def write(ctx: Any) -> None:
        if after:
            await ctx.sleep(after)
        for slot in slots:
            ctx[slot] = name

    return module.rule(when=when, writes=slots, name=name, **options)(write)


def emitter(
    module: rs.Module,
    name: str,
    when: rs.Condition,
    *signals: rs.Signal[Any],
    after: float = 0.0,
    only_if: Callable[[Any], bool] = lambda ctx: True,
    **options: Any,
) -> rs.Rule[Any, Any]:
    """Declare a rule that waits `after` seconds, and then emits its signals if `only_if` is true."""

    async def emit(ctx: Any) -> None:
        if after:
            await ctx.sleep(after)
        if only_if(ctx):
            for signal in signals:
                ctx.emit(signal, name)

    return module.rule(when=when, emits=signals, name=name, **options)(emit)


def resigner(
    module: rs.Module, name: str, when: rs.Condition, *slots: rs.Slot[Any], after: float = 0.0, **options: Any
) -> rs.Rule[Any, Any]:
    """Declare a rule that waits `after` seconds, and then resigns."""

    async def resign(ctx: Any) -> rs.Resign:
        if after:
            await ctx.sleep(after)
        return rs.Resign("not this time")

    return module.rule(when=when, writes=slots, name=name, **options)(resign)


def hearer(
    module: rs.Module, name: str, when: rs.Condition, signal: rs.Signal[Any], heard: list[Any], **options: Any
) -> rs.Rule[Any, Any]:
    """Declare a rule that only adds the payload of a signal to a list."""

    async def hear(ctx: Any) -> None:
        heard.append(ctx.payload(signal))

    return module.rule(when=when, name=name, **options)(hear)


def written(sim: Any, slot: rs.Slot[Any]) -> list[Any]:
    """Return the values that were written into a slot, in order."""
    return [r.value for r in sim.trace if isinstance(r, Set) and r.slot == slot.name]


def moments(sim: Any, slot: rs.Slot[Any]) -> list[tuple[float, Any]]:
    """Return the values that were written into a slot, each with its time (seconds)."""
    return [(round(r.time, 6), r.value) for r in sim.trace if isinstance(r, Set) and r.slot == slot.name]


def started(sim: Any) -> list[tuple[float, str]]:
    """Return the rules that began to run, each with its time (seconds)."""
    return [(round(r.time, 6), r.rule.split(":")[1]) for r in sim.trace if isinstance(r, Started)]


def outcomes(sim: Any) -> list[tuple[str, str]]:
    """Return the runs that ended, in order: rule and outcome."""
    return [(r.rule.split(":")[1], r.outcome) for r in sim.trace if isinstance(r, Settled)]


def births(sim: Any, signal: rs.Signal[Any]) -> list[Born]:
    """Return the births of a signal's spikes, in order."""
    return [r for r in sim.trace if isinstance(r, Born) and r.signal == signal.name]


def given_up(sim: Any, rule: str) -> list[tuple[float, str, str]]:
    """Return the signals that a rule gave up, each with its time (seconds) and the reason."""
    return [
        (round(r.time, 6), r.signal.split(":", 1)[1], r.reason)
        for r in sim.trace
        if isinstance(r, GaveUp) and r.rule.endswith(f":{rule}")
    ]


def pressed(sim: Any) -> list[tuple[float, str, tuple[str, ...], float]]:
    """Return the rules that came under pressure: time (seconds), rule, missing signals, end of patience (seconds)."""
    return [
        (round(r.time, 6), r.rule.split(":")[1], r.lacks, round(r.until, 6))
        for r in sim.trace
        if isinstance(r, Pressed)
    ]


def drops(sim: Any, signal: rs.Signal[Any]) -> list[Dropped]:
    """Return the withdrawals of a signal's spikes, in order."""
    return [r for r in sim.trace if isinstance(r, Dropped) and r.signal == signal.name]


def pathways(policy: rs.Policy, rule: str, clause: int = 0) -> set[str]:
    """Return the pathways of a clause, each as the short names of its signals in alphabetical order, e.g. ``"a b"``."""
    return {
        " ".join(sorted(signal.name.split(":", 1)[1] for signal in pathway))
        for pathway in policy.clauses(rule)[clause].pathways
    }


def at_rest(sim: Any) -> bool:
    """Return whether no spike, activation, group or deadline is left."""
    alive = sim.snapshot()
    return not (alive["spikes"] or alive["activations"] or alive["groups"] or alive["next_deadline"])
