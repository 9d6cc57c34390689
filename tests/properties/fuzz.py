"""Compare the engine with the interpreter of the laws (``laws/model.py``) on random worlds, with and without a tracer.

``python -m properties.fuzz [COUNT] [FIRST] [LIMIT]`` plays COUNT seeds, from FIRST or from a random number on. It prints
the smallest world for each of the first LIMIT differences. The seeds give three kinds of worlds in turn:
``random_worlds.py``, ``pair_worlds.py`` and ``crowd_worlds.py``. Many of them are varied (``variations.py``).
"""

from __future__ import annotations

import random
import sys
import time
from itertools import zip_longest
from typing import Any

from laws.model import Model
from properties.counted import BIRTHS, Counted, Endless
from properties.crowd_worlds import crowd_world_of
from properties.pair_worlds import pair_world_of
from properties.random_worlds import world_of
from properties.shrinking import shrink
from properties.variations import varied
from properties.worlds import Names, Play, World, compiled
from ravestate.declare.core import RuleFailure
from ravestate.engine.effects import Cancel, Effect, Ended, Failed, Run
from ravestate.engine.engine import Engine
from ravestate.engine.trace import Record, Tracer, Waits
from ravestate.policy.policy import Policy
from ravestate.runtime.journal import Entry, replay

MOMENTS = 300
"""A play stops after this number of moments, even if it is not over."""

STEPS = 3_000
"""The interpreter stops a play after this number of derivation steps, because it has no cache and is slow."""


ENOUGH = "too long to go on"


WORLDS = (world_of, pair_world_of, crowd_world_of)


def any_world_of(seed: int) -> World:
    """Return the world of a seed."""
    return varied(WORLDS[seed % 3](seed), seed)


class Enough(Exception):
    """Raised if the rest of a play would take the interpreter too long."""


class Interpreter(Model):
    """The interpreter of the laws. It also detects an endless instant."""

    births = 0

    def effects(self) -> list[Effect]:
        if self.steps > STEPS:
            raise Enough
        return super().effects()

    def birth(self, *args: Any) -> None:
        self.births += 1
        if self.births > BIRTHS:
            raise Endless(f"more than {BIRTHS} spikes at {self.now} s")
        super().birth(*args)


def story(world: World, machine: Any, names: Names, policy: Policy) -> list[str]:
    """Play a world on a machine: an engine or an interpreter. Return a line for each effect.

    `names` and `policy` come from `compiled`.
    """
    lines: list[str] = []

    def told(play: Play, effect: Effect) -> None:
        line = f"{play.now:10.6f} "
        match effect:
            case Run():
                run = play.engine.running[effect.run]
                needs = run.clause.needs
                held = run.held if isinstance(play.engine, Model) else run.spikes
                spikes = [f"{n.signal.name}={shown(held[n.index].payload)}@{held[n.index].born:g}" for n in needs]
                values = sorted((name, dict(v) if hasattr(v, "keys") else v) for name, v in effect.values.items())
                line += f"run {effect.run} of {effect.rule.name}[{run.clause.number}] on {' '.join(spikes)}, reading {values}"
            case Ended():
                line += f"end of run {effect.run} of {effect.rule}: {effect.outcome} {effect.fired}"
            case Cancel():
                line += f"cancel run {effect.run}: {effect.reason}"
            case Failed():
                line += f"failure of {effect.rule}: {type(effect.exception).__name__}"
            case _:
                line += repr(effect)
        lines.append(line)

    lines += played(Play(world, policy, names, started=told, machine=machine, budget=4))
    return lines


def played(play: Play) -> list[str]:
    """Play to the end, but at most `MOMENTS` moments. If the play breaks off, return the reason as the only line."""
    try:
        for _ in range(MOMENTS):
            if not play.step():
                break
    except Endless as endless:
        return [f"endless: {endless}"]
    except Enough:
        return [ENOUGH]
    return []


def shown(payload: Any) -> str:
    """Return a payload as text. The text of a failure has the type of its exception, but not its message."""
    if isinstance(payload, RuleFailure):
        return f"{payload.rule}: {type(payload.exception).__name__}"
    return repr(payload)


def difference(world: World) -> str:
    """Return a text that shows where the engine departs from the laws, or an empty text if it follows them."""
    made = compiled(world)
    laws, engine = story(world, Interpreter, *made), story(world, Counted, *made)
    for number in range(max(len(laws), len(engine))):
        one = laws[number] if number < len(laws) else "nothing more"
        other = engine[number] if number < len(engine) else "nothing more"
        if one == ENOUGH:
            break
        if one != other:
            before = "\n".join(laws[:number])
            return f"{before}\n  laws:   {one}\n  engine: {other}"
    return ""


def observation(world: World) -> str:
    """Return a text that shows what a tracer changes, or an empty text if it changes nothing (L24, L25).

    A tracer must not change the effects, even if it is added and removed during the play. A journal written with a
    tracer must replay without a tracer, and the other way round. The trace must always have the present reasons of all
    waiting activations.
    """
    reasons = Reasons()
    names, policy = compiled(world)
    plain = Play(world, policy, names, budget=4)
    traced = Play(world, policy, names, budget=4, before=reasons.compare)
    traced.engine.tracer = reasons.note
    now_and_then = Play(world, policy, names, budget=4, before=_switch)
    told = [[*play.heard, *ends] for play in (plain, traced, now_and_then) for ends in [played(play)]]
    for name, lines in zip(("traced", "traced now and then"), told[1:], strict=True):
        for one, other in zip_longest(told[0], lines, fillvalue="nothing more"):
            if one != other:
                return f"  untraced: {one}\n  {name}: {other}"
    if reasons.fault:
        return reasons.fault
    if not _repeats(plain, tracer=_ignore):
        return "  a journal written without a tracer gives other effects with a tracer"
    if not _repeats(traced, tracer=None):
        return "  a journal written with a tracer gives other effects without a tracer"
    return ""


class Reasons:
    """Compares the reasons of waits in a trace with the reasons in the engine."""

    def __init__(self) -> None:
        self.told: dict[int, tuple[str, ...]] = {}
        """For the number of each waiting activation: the names of the rules for which it waits."""
        self.fault = ""
        """The first difference as text, or an empty text."""

    def note(self, record: Record) -> None:
        """Remember the reason in a record."""
        if isinstance(record, Waits):
            self.told[record.activation] = record.for_

    def compare(self, play: Play) -> None:
        """Compare the reasons, before time passes."""
        for one in play.engine.waiting:
            told, names = self.told.get(one.id, ()), tuple(one.refusal.all_names)
            if set(told) != set(names) and not self.fault:
                self.fault = f"  at {play.now:g} s {one} waits for {names}, but the trace says {told}"


def _switch(play: Play) -> None:
    """Add or remove the tracer."""
    play.engine.tracer = None if play.engine.tracer is not None or not len(play.journal) % 3 else _ignore


def _ignore(record: Record) -> None:
    """Ignore a record."""


def _repeats(play: Play, *, tracer: Tracer | None) -> bool:
    """Return whether the journal of a play gives the same effects if it is replayed with this tracer."""
    assert play.policy is not None
    engine = Engine(play.policy, patience=play.world.patience, report_ends=True)
    engine.tracer = tracer
    return repr(replay(engine, [Entry(time, event) for time, event in play.journal])) == repr(play.taken)


def verdict(world: World) -> str:
    """Return the kind of a fault, the repr of an exception, or an empty text if the engine follows the laws."""
    try:
        return "differs" if difference(world) else "a tracer changes it" if observation(world) else ""
    except Exception as exception:
        return repr(exception)


def main(count: int, first: int, limit: int = 1) -> int:
    """Play `count` seeds. Shrink and print the first `limit` differences. Return the number of all differences."""
    faults: list[int] = []
    start = time.process_time()
    for seed in range(first, first + count):
        if seed > first and (seed - first) % 500 == 0:
            print(f"{seed - first} of {count} seeds: {len(faults)} differences", file=sys.stderr, flush=True)
        world = any_world_of(seed)
        fault = verdict(world)
        if fault:
            print(f"seed {seed}: {fault}", flush=True)
            faults.append(seed)
            if len(faults) <= limit:
                least = shrink(world, verdict)
                try:
                    words = difference(least) or observation(least)
                except Exception as exception:
                    words = f"breaks: {exception!r}"
                print(f"seed {seed}: {least!r}\n{words}\n", flush=True)
    print(
        f"{count} seeds from {first}: {len(faults)} differences {faults[:20]}, {time.process_time() - start:.1f} s of CPU"
    )
    return len(faults)


if __name__ == "__main__":
    arguments = [int(argument) for argument in sys.argv[1:]]
    begin = arguments[1] if len(arguments) > 1 else random.SystemRandom().randrange(10**9)
    sys.exit(min(1, main(arguments[0] if arguments else 20_000, begin, arguments[2] if len(arguments) > 2 else 1)))
