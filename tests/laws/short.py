"""Short words for rules of few lines, and for what a trace says."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import ravestate as rs
from ravestate.engine.trace import Born, Dropped, GaveUp, Pressed, Set, Settled, Started


def output(module: rs.Module, name: str = "out") -> rs.Slot[str]:
    """A slot into which the same thing may be said twice."""
    return module.slot(name, "", always=True)


def writer(
    module: rs.Module, name: str, when: rs.Condition, *slots: rs.Slot[Any], after: float = 0.0, **options: Any
) -> rs.Rule[Any, Any]:
    """A rule that takes some seconds and then writes its own name into its slots."""

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
    """A rule that takes some seconds and then emits its signals, or, where ``only_if`` says no, does not."""

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
    """A rule that takes some seconds and then resigns."""

    async def resign(ctx: Any) -> rs.Resign:
        if after:
            await ctx.sleep(after)
        return rs.Resign("not this time")

    return module.rule(when=when, writes=slots, name=name, **options)(resign)


def hearer(
    module: rs.Module, name: str, when: rs.Condition, signal: rs.Signal[Any], heard: list[Any], **options: Any
) -> rs.Rule[Any, Any]:
    """A rule that only notes the payload of a signal."""

    async def hear(ctx: Any) -> None:
        heard.append(ctx.payload(signal))

    return module.rule(when=when, name=name, **options)(hear)


def written(sim: Any, slot: rs.Slot[Any]) -> list[Any]:
    """What was written into a slot, in order."""
    return [r.value for r in sim.trace if isinstance(r, Set) and r.slot == slot.name]


def moments(sim: Any, slot: rs.Slot[Any]) -> list[tuple[float, Any]]:
    """When (seconds) something was written into a slot, and what."""
    return [(round(r.time, 6), r.value) for r in sim.trace if isinstance(r, Set) and r.slot == slot.name]


def started(sim: Any) -> list[tuple[float, str]]:
    """When (seconds) which rule began to run."""
    return [(round(r.time, 6), r.rule.split(":")[1]) for r in sim.trace if isinstance(r, Started)]


def outcomes(sim: Any) -> list[tuple[str, str]]:
    """How which run ended, in order."""
    return [(r.rule.split(":")[1], r.outcome) for r in sim.trace if isinstance(r, Settled)]


def births(sim: Any, signal: rs.Signal[Any]) -> list[Born]:
    """The spikes of a signal, in order."""
    return [r for r in sim.trace if isinstance(r, Born) and r.signal == signal.name]


def given_up(sim: Any, rule: str) -> list[tuple[float, str, str]]:
    """When (seconds) a rule gave up which signal, and why."""
    return [
        (round(r.time, 6), r.signal.split(":", 1)[1], r.reason)
        for r in sim.trace
        if isinstance(r, GaveUp) and r.rule.endswith(f":{rule}")
    ]


def pressed(sim: Any) -> list[tuple[float, str, tuple[str, ...], float]]:
    """When (seconds) which rule came under pressure, what it lacked, and until when it had patience."""
    return [
        (round(r.time, 6), r.rule.split(":")[1], r.lacks, round(r.until, 6))
        for r in sim.trace
        if isinstance(r, Pressed)
    ]


def drops(sim: Any, signal: rs.Signal[Any]) -> list[Dropped]:
    """The spikes of a signal that were withdrawn, in order."""
    return [r for r in sim.trace if isinstance(r, Dropped) and r.signal == signal.name]


def pathways(policy: rs.Policy, rule: str, clause: int = 0) -> set[str]:
    """The pathways of a clause; the short names of each one's signals in alphabetical order, e.g. ``"a b"``."""
    return {
        " ".join(sorted(signal.name.split(":", 1)[1] for signal in pathway))
        for pathway in policy.clauses(rule)[clause].pathways
    }


def at_rest(sim: Any) -> bool:
    """Whether no spike, activation, group or deadline is left."""
    alive = sim.snapshot()
    return not (alive["spikes"] or alive["activations"] or alive["groups"] or alive["next_deadline"])
