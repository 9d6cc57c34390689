"""A journal of an engine's events, and the replay of a journal: the same events give the same effects (law L24).

An *effect* is an instruction of the engine to the runtime, for instance to call the function of a rule.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace

from ravestate.engine.effects import Effect
from ravestate.engine.engine import Engine
from ravestate.engine.events import Event


@dataclass(slots=True)
class Taken:
    """A mark in the journal: at this point, the runner took the engine's effects.

    The engine makes decisions only when the runner takes its effects. So a replay must take them at the same points.
    """


@dataclass(frozen=True, slots=True)
class Entry:
    """An event, or a `Taken`, with its time (seconds since the context started)."""

    time: float
    event: Event | Taken


class Journal:
    """A list of all events in memory, in order. ``Context(..., journal=Journal())`` fills it."""

    def __init__(self) -> None:
        self.entries: list[Entry] = []

    def __call__(self, event: Event | Taken, time: float) -> None:
        self.entries.append(Entry(time, replace(event)))


def replay(engine: Engine, entries: Iterable[Entry]) -> list[list[Effect]]:
    """Feed a journal to an engine; return the effects for each `Taken`. No rule's function is called.

    The engine must be new, and have the policy and the patience of the journal's context.
    """
    done: list[list[Effect]] = []
    for entry in entries:
        if isinstance(entry.event, Taken):
            engine.advance(entry.time)
            done.append(engine.effects())
        else:
            engine.receive(entry.event, entry.time)
    return done
