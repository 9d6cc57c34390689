"""An engine that detects an endless instant."""

from __future__ import annotations

from typing import Any

import ravestate as rs
from ravestate.engine.engine import Engine
from ravestate.engine.events import Event

BIRTHS = 2_000
"""The number of spikes after which an instant counts as endless."""


class Endless(AssertionError):
    """Raised if the engine does not come to rest within one instant."""


class Counted:
    """An engine that raises `Endless` if it does not come to rest within one instant. It has an engine's methods."""

    def __init__(self, policy: rs.Policy, **options: Any) -> None:
        self.engine = Engine(policy, **options)
        self.before = 0

    @property
    def births(self) -> int:
        """The number of spikes that were born in this instant."""
        return self.engine.state.spikes - self.before

    @births.setter
    def births(self, number: int) -> None:
        self.before = self.engine.state.spikes - number

    @property
    def tracer(self) -> Any:
        """The function that gets the trace's records, or None."""
        return self.engine.tracer

    @tracer.setter
    def tracer(self, tracer: Any) -> None:
        self.engine.tracer = tracer

    def receive(self, event: Event, now: float) -> None:
        self.engine.receive(event, now)
        if self.births > BIRTHS:
            raise Endless(f"more than {BIRTHS} spikes at {self.now} s")

    def __getattr__(self, name: str) -> Any:
        return getattr(self.engine, name)
