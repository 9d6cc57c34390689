"""The Signal-Rule-Slot automaton as a pure state machine.

The engine has four verbs: `receive` an event, `advance` to a time, ask for the `next_deadline`, take the `effects`.
Time is an argument, in seconds from any origin. The engine uses no clock, thread or event loop.

Most engines are at rest most of the time: they have no live spike or activation, and nothing is left to do. Such an
engine has only its `Memory` (its slots and counters). To handle an event, it borrows `Parts` (the objects that do the
work) from the policy. It returns them when it comes to rest.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from math import inf
from typing import Any, Final

from ravestate.engine.activation import Activation
from ravestate.engine.effects import Effect
from ravestate.engine.events import Event
from ravestate.engine.group import NOTHING
from ravestate.engine.memory import Memory
from ravestate.engine.parts import HANDLERS, Parts
from ravestate.engine.state import State
from ravestate.engine.trace import Tracer
from ravestate.errors import EngineError
from ravestate.policy.policy import Policy

DEFAULT_PATIENCE = 1.0
"""By default, activations wait this long (seconds) for a rival that may never be ready: its *patience* (law L16)."""

SPARE: Final = 64
"""The maximum number of unused `Parts` that a policy keeps for its engines."""


class Engine:
    """A running automaton. Any number of engines may share one policy.

    Args:
        policy: A policy from ``rs.compile``.
        patience: The patience of rivals under pressure, in seconds, unless their rule sets its own (L16).
        report_ends: Whether the engine reports the end of each run as an `Ended` effect.

    Example:
        >>> import ravestate as rs
        >>> from ravestate.engine.events import Start
        >>> engine = Engine(rs.compile())
        >>> engine.receive(Start(), 0.0)
        >>> engine.effects()
        []
    """

    __slots__ = ("__weakref__", "_memory", "_parts", "policy")

    def __init__(self, policy: Policy, *, patience: float = DEFAULT_PATIENCE, report_ends: bool = False) -> None:
        self.policy = policy
        """The policy. Each event `AddRule` replaces it by a policy with more rules."""
        self._memory = Memory(policy, patience, report_ends)
        self._parts: Parts | None = None

    # ------------------------------------------------------------------------------------ the four verbs

    def receive(self, event: Event, now: float) -> None:
        """Handle an event at the time `now` (seconds). If `now` has passed already, the latest time so far counts.

        Raises:
            UndeclaredError: The policy does not have the signal or slot of the event, or a run writes a slot that its
                rule does not declare.
            RuleError: The value for a collection is not a mapping.
            EngineError: The event comes from a run that is over, or its type or its `Finish.kind` is unknown. Or the
                event stores or removes an item, but the slot is no collection. Or the event adds a policy that does not
                extend the present one.
            ValueError: `now` is NaN or infinity.
        """
        rested = self._parts is None
        parts = self.parts_at(now)
        handler = HANDLERS.get(type(event))
        if handler is None:
            raise EngineError(f"{event!r} is not an event: see ravestate.engine.events")
        handler(parts, event)
        self.policy = parts.state.policy
        if rested and parts.state.at_rest:
            self._rest(parts)  # no rule hears the event

    def advance(self, now: float) -> None:
        """Let time pass until `now` (seconds), deadline by deadline.

        If `now` is not later than the present time, only handle the deadlines that are due by `now`.

        Raises:
            ValueError: `now` is NaN or infinity.
        """
        if not now < inf:  # this is true of NaN, too
            raise ValueError(f"advance({now!r}): write a finite number of seconds")
        if self._parts is not None:
            self._parts.advance(now)
        else:
            self._memory.now = max(self._memory.now, now)

    def next_deadline(self) -> float | None:
        """Return the time (seconds) at which to call `advance` next, unless an event comes first; None for never."""
        return None if self._parts is None else self._parts.state.deadlines.next()

    def effects(self) -> list[Effect]:
        """Return the effects to perform now. Call this again after performing them, until the list is empty.

        First give the engine all events of this instant, such as the ends of runs. This call decides what starts.
        """
        parts = self._parts
        if parts is None:
            return []
        effects = parts.effects()
        if not effects:
            self.rest()
        return effects

    # ------------------------------------------------------------------------------------ work and rest

    @property
    def parts(self) -> Parts:
        """The parts of the engine. An engine at rest borrows parts first."""
        parts = self._parts
        if parts is None:
            spare = self._memory.policy.spare
            try:
                parts = spare.pop()
            except IndexError:
                parts = Parts(self._memory.policy)
            parts.state.begin(self._memory)
            self._parts = parts
        return parts

    def parts_at(self, now: float) -> Parts:
        """Let time pass until `now` (seconds), and return the parts. If the caller gives them an event, no journal
        records it."""
        parts = self._parts or self.parts
        if now != parts.state.now:
            parts.pass_time(now)
        return parts

    def rest(self) -> None:
        """Return the parts to the policy if nothing is live or left to do. Call this after reading `state`, which
        borrows them."""
        parts = self._parts
        if parts is not None and parts.state.at_rest:
            self._rest(parts)

    def _rest(self, parts: Parts) -> None:
        self._parts = None
        parts.agenda.breakers.clear()
        parts.state.end(self._memory)
        spare = self._memory.policy.spare
        if len(spare) < SPARE:
            spare.append(parts)

    # ------------------------------------------------------------------------------------ questions

    @property
    def state(self) -> State:
        """The tables of the engine. The engine's parts change them. Other code may read them until the next event."""
        return self.parts.state

    @property
    def now(self) -> float:
        """The latest time that the engine has reached (seconds)."""
        return self._latest.now

    @property
    def tracer(self) -> Tracer | None:
        """The function that gets the trace's records, or None."""
        return None if self._parts is None else self._parts.state.tracer

    @tracer.setter
    def tracer(self, tracer: Tracer | None) -> None:
        if tracer is not None or self._parts is not None:
            self.parts.state.tracer = tracer

    @property
    def watched(self) -> dict[str, int]:
        """Key: the name of a signal whose spikes are reported as effects; the value is always 1."""
        return self._latest.watched

    @property
    def running(self) -> Mapping[int, Activation]:
        """Number of a run → the activation whose function runs."""
        return NOTHING if self._parts is None else self._parts.state.running

    @property
    def waiting(self) -> Iterable[Activation]:
        """The ready activations that were refused consent."""
        return () if self._parts is None else self._parts.state.waiting

    @property
    def late_turns(self) -> int:
        """How many deferred turns (runs of an endless loop) ran in this instant after an error had named their loop
        (`Loops.late`, L23)."""
        return 0 if self._parts is None else self._parts.state.loops.late

    def read(self, slot: int) -> Any:
        """Return the value of the slot with this index."""
        return self._latest.read(slot)

    @property
    def _latest(self) -> Memory:
        return self._memory if self._parts is None else self._parts.state
