"""A journal of what an engine was told, and replay: the same events give the same effects (L24)."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace

from ravestate.engine.effects import Effect
from ravestate.engine.engine import Engine
from ravestate.engine.events import Event

__all__ = ["Entry", "Journal", "replay"]


@dataclass(frozen=True, slots=True)
class Entry:
    """An event, and when it was received (seconds since the context began)."""

    time: float
    event: Event


class Journal:
    """Keeps every event in memory, in order. ``Context(..., journal=Journal())`` fills one."""

    def __init__(self) -> None:
        self.entries: list[Entry] = []

    def __call__(self, event: Event, time: float) -> None:
        self.entries.append(Entry(time, replace(event)))


def replay(engine: Engine, entries: Iterable[Entry]) -> list[list[Effect]]:
    """Feed a journal to an engine, and return what it asked for between the events; no rule function is called."""
    done: list[list[Effect]] = []
    for entry in entries:
        engine.advance(entry.time)
        effects = list(_drain(engine))
        engine.receive(entry.event, entry.time)
        done.append(effects)
    done.append(list(_drain(engine)))
    return done


def _drain(engine: Engine) -> Iterable[Effect]:
    while effects := engine.effects():
        yield from effects
