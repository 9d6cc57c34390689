"""The Signal-Rule-Slot automaton as a pure state machine.

The engine has four verbs: `receive` an event, `advance` to a time, ask for the `next_deadline`, take the `effects`.
Time is an argument, in seconds from any origin. Nothing here knows a clock, a thread or a loop.

This file has the events, the deadlines and the order of the effects. The work is in the engine's parts, one file each;
they share one `State`.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from ravestate.engine import events
from ravestate.engine.activation import NEVER, RUNNING, WAITING, Activation
from ravestate.engine.agenda import Agenda
from ravestate.engine.conflict_sets import ConflictSets
from ravestate.engine.consent import Consent
from ravestate.engine.deadlines import LOOK, Kind
from ravestate.engine.effects import Effect
from ravestate.engine.entries import Entries
from ravestate.engine.events import Event
from ravestate.engine.group import Group
from ravestate.engine.halves import Halves
from ravestate.engine.holdings import Holdings
from ravestate.engine.matching import Matching
from ravestate.engine.outcomes import DONE, KINDS, RETIRED
from ravestate.engine.runs import Runs
from ravestate.engine.slots import ABSENT, Slots
from ravestate.engine.spike import Spike
from ravestate.engine.state import State
from ravestate.engine.trace import Tracer
from ravestate.engine.waits import Waits
from ravestate.engine.watch import Watch
from ravestate.errors import EngineError, UndeclaredError, nearest
from ravestate.policy.model import Need, RulePlan, SignalPlan, SlotPlan
from ravestate.policy.policy import Policy

DEFAULT_PATIENCE = 1.0
"""The default patience of a rival under pressure, in seconds (L16)."""


class Engine:
    """A running automaton. Any number of engines may share one policy.

    Args:
        policy: A policy from ``rs.compile``.
        patience: The patience of rivals under pressure, in seconds, unless their rule sets its own (L16).
        report_ends: Whether each run ends with an `Ended` effect.

    Attributes:
        state: The tables of the engine. The engine's parts change them; other code may read them.

    Example:
        >>> import ravestate as rs
        >>> from ravestate.engine.events import Start
        >>> engine = Engine(rs.compile())
        >>> engine.receive(Start(), 0.0)
        >>> engine.effects()
        []
    """

    __slots__ = ("__weakref__", "agenda", "halves", "holdings", "matching", "runs", "slots", "state")

    def __init__(self, policy: Policy, *, patience: float = DEFAULT_PATIENCE, report_ends: bool = False) -> None:
        state = self.state = State(policy, patience)
        waits, entries = Waits(state), Entries(state)
        holdings = self.holdings = Holdings(state, entries, waits)
        sets = ConflictSets(state, holdings)
        halves = self.halves = Halves(state, entries, holdings, sets)
        runs = self.runs = Runs(state, holdings, sets, report_ends)
        self.matching = Matching(state, entries, holdings, sets, halves, runs)
        self.slots = Slots(state, self.matching)
        self.agenda = Agenda(state, runs, self.slots, Consent(state, holdings, halves))

    # ------------------------------------------------------------------------------------ the four verbs

    def receive(self, event: Event, now: float) -> None:
        """Handle an event at the time `now` (seconds). A time before that of an earlier call counts as the latest time.

        Raises:
            UndeclaredError: The event names a signal or slot that the policy does not have.
            EngineError: The event comes from a run that is over.
        """
        self.pass_time(now)
        handler = HANDLERS.get(type(event))
        if handler is None:
            raise EngineError(f"{event!r} is not an event: see ravestate.engine.events")
        handler(self, event)

    def pass_time(self, now: float) -> None:
        """Let time pass until `now` (seconds), before an event; an earlier time counts as the latest time."""
        state = self.state
        if now > state.now:
            self.holdings.waits.pass_time()
            if state.deadlines.earliest <= now:
                self.advance(now)
            state.now = now
        elif now != now:  # NaN is neither before nor after
            raise EngineError("the time is not a number of seconds: it is NaN")

    def advance(self, now: float) -> None:
        """Let time pass until `now` (seconds), deadline by deadline. A repeated or early call changes nothing."""
        state = self.state
        entry = state.deadlines.pop(now)
        while entry is not None:
            time, kind, _, owner = entry
            state.now = max(state.now, time)
            DUE[kind](self, time, owner)
            entry = state.deadlines.pop(now)
        state.now = max(state.now, now)

    def next_deadline(self) -> float | None:
        """Return the time (seconds) at which to call `advance` next, unless an event comes first; None for never."""
        return self.state.deadlines.next()

    def effects(self) -> list[Effect]:
        """Return the effects to perform now. Call this again after performing them, until the list is empty."""
        state, agenda = self.state, self.agenda
        # Reports (of spikes, ends, failures) do not end the loop: only a run to start or cancel does.
        while not state.acts:
            if state.deadlines.earliest <= state.now:
                self.advance(state.now)
            elif state.errors:
                failure, lineage = state.errors[0]
                state.errors = state.errors[1:]
                error = state.policy.signal_of["core:error"]
                self.matching.birth(error, failure, (), self.matching.new_group(), None, lineage)
            elif state.busy and not state.values.get(state.activity.index):
                self.slots.set_flag(state.activity, True)
            elif state.free:
                agenda.start_free()
            elif agenda.has_questions:
                agenda.consent_round()
            elif agenda.settle_flags():
                pass
            elif state.loops.deferred and (turn := state.loops.next()) is not None:
                self.holdings.complete(turn, late=True)
            else:
                state.loops.rest()
                break
        out = state.out
        state.out = []
        state.acts = False
        return out

    # ------------------------------------------------------------------------------------ the commonest events
    # The runner calls these, after `pass_time`, if nothing records the events.

    def write(self, slot: str, value: Any, run: int | None) -> None:
        """Handle the event `Write` at the present time."""
        self.slots.write(self._slot(slot), value, None if run is None else self._run(run))

    def emit(self, signal: str, payload: Any, run: int | None) -> None:
        """Handle the event `Emit` at the present time."""
        self.matching.emit(self._signal(signal), payload, None if run is None else self._run(run))

    def done(self, run: int) -> None:
        """Handle the event `Finish` at the present time, for a run that is done."""
        self.runs.finish(self._run(run), DONE, "", None)

    # ------------------------------------------------------------------------------------ events

    def on_start(self, event: events.Start) -> None:
        self.matching.emit(self.state.signal_of["core:startup"], None, None)

    def on_stop(self, event: events.Stop) -> None:
        self.matching.emit(self.state.signal_of["core:shutdown"], None, None)

    def on_write(self, event: events.Write) -> None:
        self.write(event.slot, event.value, event.run)

    def on_store(self, event: events.Store) -> None:
        slot = self._collection(event.slot)
        self.slots.store(slot, event.key, event.item, None if event.run is None else self._run(event.run))

    def on_discard(self, event: events.Discard) -> None:
        slot = self._collection(event.slot)
        self.slots.store(slot, event.key, ABSENT, None if event.run is None else self._run(event.run))

    def on_emit(self, event: events.Emit) -> None:
        self.emit(event.signal, event.payload, event.run)

    def on_wipe(self, event: events.Wipe) -> None:
        signal = self._signal(event.signal)
        wiper = None if event.run is None else self._run(event.run)
        state = self.state
        tables: list[Iterable[Spike]] = [*state.live.values(), state.watched_by]
        known = {spike for spikes in tables for spike in spikes}
        for spike in sorted((s for s in known if s.comes_from(signal.name)), key=lambda spike: spike.id):
            for holder in sorted(spike.holders, key=lambda holder: (holder.clause.index, holder.id)):
                if holder.state == RUNNING and holder is not wiper and holder.clause.rule.interruptible:
                    self.runs.cancel(holder, "wiped")
            self.holdings.kill(spike, "wiped")

    def on_finish(self, event: events.Finish) -> None:
        if event.kind not in KINDS:
            raise EngineError(f"a run ends by one of {', '.join(KINDS)}, not by {event.kind!r}")
        run = self._run(event.run)
        self.runs.finish(run, event.kind, event.reason, event.exception)
        if event.kind == RETIRED:
            self._retire(run.clause.rule)

    def on_add_rule(self, event: events.AddRule) -> None:
        """Replace the policy by one that begins with the same rules in the same order, and has more."""
        state = self.state
        known, plans = state.policy.rule_plans, event.policy.rule_plans
        if [plan.rule for plan in plans[: len(known)]] != [plan.rule for plan in known]:
            raise EngineError("the new policy does not extend the running one: make it with policy.with_rule(rule)")
        self.halves.unfold_all()
        state.adopt(event.policy)
        state.asking.update(state.waiting)
        for plan in plans[len(known) :]:
            looking = [clause for clause in plan.clauses if clause.asks_detached]
            for need in (need for clause in looking for need in clause.needs if need.detached):
                for spike in state.live.get(need.signal.index, ()):
                    if spike.born + need.min_age > state.now:  # a spike sets these times at its birth for older rules
                        state.deadlines.add(spike.born + need.min_age, LOOK, (need, spike))

    def _retire(self, rule: RulePlan) -> None:
        """Remove a rule from the context (L18)."""
        self.halves.unfold_all()
        self.state.retired |= {rule.index}
        for activation in list(self.state.active.get(rule.index, ())):
            if activation.state < RUNNING:
                self.holdings.end(activation, "retired")
        self.state.asking.update(self.state.waiting)  # these may have waited for signals of the retired rule

    # ------------------------------------------------------------------------------------ deadlines

    def on_ripen(self, time: float, activation: Activation) -> None:
        self.holdings.on_ripen(activation)

    def on_look(self, time: float, looking: tuple[Need, Spike]) -> None:
        self.matching.on_look(looking)

    def on_recheck(self, time: float, activation: Activation) -> None:
        if activation.state == WAITING and activation.refusal is not None:
            activation.refusal.recheck = NEVER
            self.state.asking[activation] = None

    def on_patience(self, time: float, owner: tuple[Group, Activation]) -> None:
        self.state.dirty[owner[0].root()] = None

    def on_expire(self, time: float, spike: Spike) -> None:
        self.holdings.on_expire(time, spike)

    def on_forget(self, time: float, spike: Spike) -> None:
        self.holdings.entries.on_forget(spike)

    def on_timeout(self, time: float, run: Activation) -> None:
        self.runs.cancel(run, "timeout")

    def on_watch(self, time: float, watch: Watch) -> None:
        self.runs.on_watch(watch)

    # ------------------------------------------------------------------------------------ questions

    @property
    def policy(self) -> Policy:
        """The policy; it has more rules after each `AddRule`."""
        return self.state.policy

    @property
    def now(self) -> float:
        """The time of the latest event or deadline (seconds)."""
        return self.state.now

    @property
    def tracer(self) -> Tracer | None:
        """The function that gets the trace's records, or None."""
        return self.state.tracer

    @tracer.setter
    def tracer(self, tracer: Tracer | None) -> None:
        self.state.tracer = tracer

    @property
    def watched(self) -> dict[str, int]:
        """The names of the signals whose spikes are reported as effects, as the keys of a table."""
        return self.state.watched

    @property
    def running(self) -> Mapping[int, Activation]:
        """Number of a run → the activation whose function runs."""
        return self.state.running

    @property
    def waiting(self) -> Iterable[Activation]:
        """The ready activations that were refused consent."""
        return self.state.waiting

    @property
    def late_turns(self) -> int:
        """The number of deferred turns that endless loops have had in this instant, after all other rules (L23)."""
        return self.state.loops.late

    def read(self, slot: int) -> Any:
        """Return the value of the slot with this number."""
        return self.state.read(slot)

    def _signal(self, name: str) -> SignalPlan:
        signal = self.state.signal_of.get(name)
        if signal is None:
            raise UndeclaredError(_unknown("signal", name, self.state.policy.signals))
        return signal

    def _slot(self, name: str) -> SlotPlan:
        slot = self.state.slot_of.get(name)
        if slot is None:
            raise UndeclaredError(_unknown("slot", name, self.state.policy.slots))
        return slot

    def _collection(self, name: str) -> SlotPlan:
        slot = self._slot(name)
        if not slot.is_collection:
            raise EngineError(f"{name} is not a collection: use Write({name!r}, value)")
        return slot

    def _run(self, number: int) -> Activation:
        run = self.state.running.get(number)
        if run is None:
            raise EngineError(f"run {number} is over, or never began")
        return run


HANDLERS: dict[type, Any] = {
    events.Start: Engine.on_start,
    events.Stop: Engine.on_stop,
    events.Write: Engine.on_write,
    events.Store: Engine.on_store,
    events.Discard: Engine.on_discard,
    events.Emit: Engine.on_emit,
    events.Wipe: Engine.on_wipe,
    events.Finish: Engine.on_finish,
    events.AddRule: Engine.on_add_rule,
}
"""Type of an event → its handler."""

DUE: dict[Kind, Any] = {
    Kind.RIPEN: Engine.on_ripen,
    Kind.LOOK: Engine.on_look,
    Kind.RECHECK: Engine.on_recheck,
    Kind.PATIENCE: Engine.on_patience,
    Kind.EXPIRE: Engine.on_expire,
    Kind.FORGET: Engine.on_forget,
    Kind.TIMEOUT: Engine.on_timeout,
    Kind.WATCH: Engine.on_watch,
}
"""Kind of a deadline → its handler."""


def _unknown(what: str, name: str, names: Iterable[str]) -> str:
    return f"the policy has no {what} {name!r}{nearest(name, names)}"
