"""The parts of a working engine. Each part has a file of its own, and all share one `State`.

This file has the handlers of events and deadlines, and the loop that decides what comes next. The parts do the work.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from ravestate.engine import events
from ravestate.engine.activation import NEVER, RUNNING, WAITING, Activation
from ravestate.engine.agenda import Agenda
from ravestate.engine.conflict_sets import ConflictSets
from ravestate.engine.consent import Consent
from ravestate.engine.deadlines import LOOK, Kind
from ravestate.engine.effects import Effect
from ravestate.engine.entries import Entries
from ravestate.engine.group import Group
from ravestate.engine.halves import Halves
from ravestate.engine.holdings import Holdings
from ravestate.engine.matching import Matching
from ravestate.engine.outcomes import DONE, KINDS, RETIRED
from ravestate.engine.runs import Runs
from ravestate.engine.slots import ABSENT, Slots
from ravestate.engine.spike import Spike
from ravestate.engine.state import State
from ravestate.engine.waits import Waits
from ravestate.engine.watch import Watch
from ravestate.errors import EngineError, UndeclaredError, nearest
from ravestate.policy.model import Need, RulePlan, SignalPlan, SlotPlan
from ravestate.policy.policy import Policy


class Parts:
    """The parts of one working engine, with the `State` that they share.

    Only `Agenda`, and `Leaders` inside `Consent`, have tables of their own.
    """

    __slots__ = ("agenda", "halves", "holdings", "matching", "runs", "slots", "state")

    def __init__(self, policy: Policy) -> None:
        state = self.state = State(policy)
        waits, entries = Waits(state), Entries(state)
        holdings = self.holdings = Holdings(state, entries, waits)
        sets = ConflictSets(state, holdings)
        halves = self.halves = Halves(state, entries, holdings, sets)
        runs = self.runs = Runs(state, holdings, sets)
        self.matching = Matching(state, entries, holdings, sets, halves, runs)
        self.slots = Slots(state, self.matching)
        self.agenda = Agenda(state, runs, self.slots, Consent(state, holdings, halves))

    # ------------------------------------------------------------------------------------ time and effects

    def pass_time(self, now: float) -> None:
        """Let time pass until `now` (seconds), before an event. If `now` is not later than the present, do nothing.

        Raises:
            ValueError: The time is NaN or infinity.
        """
        state = self.state
        if now > state.now:
            due = state.deadlines.earliest <= now  # also if there is no deadline and the time is infinity
            if due and now == NEVER:
                raise ValueError(f"the time is {now!r}: write a finite number of seconds")
            self.holdings.waits.pass_time()
            if due:
                self.advance(now)
            state.now = now
        elif now != now:  # NaN is neither before nor after
            raise ValueError(f"the time is {now!r}: write a finite number of seconds")

    def advance(self, now: float) -> None:
        """Let time pass until `now` (seconds), deadline by deadline.

        If `now` is not later than the present time, only handle the deadlines that are due by `now`.
        """
        state = self.state
        entry = state.deadlines.pop(now)
        while entry is not None:
            time, kind, _, owner = entry
            state.now = max(state.now, time)
            DUE[kind](self, time, owner)
            entry = state.deadlines.pop(now)
        state.now = max(state.now, now)

    def effects(self) -> list[Effect]:
        """Return the effects to perform now. Call this again after performing them, until the list is empty."""
        state, agenda = self.state, self.agenda
        free = state.free
        # Reports (of spikes, ends, failures) do not end the loop: only an order to start or cancel a run does.
        while not state.acts:
            if state.faults:
                state.report_faults()
            if state.deadlines.earliest <= state.now:
                self.advance(state.now)
            elif state.errors:
                failure, lineage, origin = state.errors[0]
                state.errors = state.errors[1:]
                error = state.policy.signal_of["core:error"]
                self.matching.birth(error, failure, (), self.matching.new_group(), None, origin, lineage)
            elif state.busy and not state.values.get(state.activity.index):
                self.slots.set_flag(state.activity, True)
            elif free.new or free.batch or free.line:
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
        if state.faults:
            state.report_faults()
        out = state.out
        state.out = []
        state.acts = False
        return out

    # ------------------------------------------------------------------------------------ the commonest events
    # In the loop's thread, if no journal records events, the runner calls these methods directly, after
    # `Engine.parts_at`. Otherwise, it makes an event, whose handler does the same.

    def write(self, slot: str, value: Any, run: int | None, origin: Any = None) -> None:
        """Handle the event `Write` now; `run` is the number of the run, or None for code outside the rules."""
        state = self.state
        writer = None if run is None else state.running.get(run) or self._run(run)
        self.slots.write(state.slot_of.get(slot) or self._slot(slot), value, writer, origin)

    def emit(self, signal: str, payload: Any, run: int | None, origin: Any = None) -> None:
        """Handle the event `Emit` now; `run` is the number of the run, or None for code outside the rules."""
        state = self.state
        emitter = None if run is None else state.running.get(run) or self._run(run)
        self.matching.emit(state.signal_of.get(signal) or self._signal(signal), payload, emitter, origin)

    def done(self, run: int) -> None:
        """Handle the event `Finish` now, for a run that is done."""
        self.runs.finish(self.state.running.get(run) or self._run(run), DONE, "", None)

    # ------------------------------------------------------------------------------------ events

    def on_start(self, event: events.Start) -> None:
        """Raise ``core:startup``."""
        self.matching.emit(self.state.signal_of["core:startup"], None, None)

    def on_stop(self, event: events.Stop) -> None:
        """Raise ``core:shutdown``."""
        self.matching.emit(self.state.signal_of["core:shutdown"], None, None)

    def on_write(self, event: events.Write) -> None:
        """Write a slot."""
        self.write(event.slot, event.value, event.run, event.origin)

    def on_store(self, event: events.Store) -> None:
        """Store an item in a collection."""
        slot = self._collection(event.slot)
        self.slots.store(slot, event.key, event.item, None if event.run is None else self._run(event.run))

    def on_discard(self, event: events.Discard) -> None:
        """Remove an item from a collection."""
        slot = self._collection(event.slot)
        self.slots.store(slot, event.key, ABSENT, None if event.run is None else self._run(event.run))

    def on_emit(self, event: events.Emit) -> None:
        """Raise a signal."""
        self.emit(event.signal, event.payload, event.run, event.origin)

    def on_wipe(self, event: events.Wipe) -> None:
        """Withdraw the live spikes of a signal and all their descendants. Cancel the runs that hold one of them, except
        the run that wipes and runs that cannot be cancelled."""
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
        """Settle a run whose function has ended (L18)."""
        if event.kind not in KINDS:
            raise EngineError(f"a run ends by one of {', '.join(KINDS)}, not by {event.kind!r}")
        run = self._run(event.run)
        self.runs.finish(run, event.kind, event.reason, event.exception)
        if event.kind == RETIRED:
            self._retire(run.clause.rule)

    def on_add_rule(self, event: events.AddRule) -> None:
        """Replace the policy by a policy that begins with the same rules in the same order, and has more rules."""
        state = self.state
        known, plans = state.policy.rule_plans, event.policy.rule_plans
        if [plan.rule for plan in plans[: len(known)]] != [plan.rule for plan in known]:
            raise EngineError("the new policy does not extend the running one: make it with policy.with_rule(rule)")
        self.halves.unfold_all()
        self.halves.share(event.policy)
        state.adopt(event.policy)
        state.asking.update(state.waiting)
        for plan in plans[len(known) :]:
            for need in (need for clause in plan.clauses for need in clause.needs if need.predicates):
                for spike in state.live.get(need.signal.index, ()):
                    state.accepts(need, spike.payload)  # only to report a predicate that raises an exception
            looking = [clause for clause in plan.clauses if clause.asks_detached]
            for need in (need for clause in looking for need in clause.needs if need.detached):
                for spike in state.live.get(need.signal.index, ()):
                    if spike.born + need.min_age > state.now:  # its birth set such times for older rules only
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
        """Judge an activation again, because its spikes are old enough (L14)."""
        activation.ripens = NEVER
        self.holdings.update(activation)

    def on_look(self, time: float, looking: tuple[Need, Spike]) -> None:
        """Show a spike to a detached need (a constraint that only looks) for which it is old enough now (L19)."""
        self.matching.on_look(looking)

    def on_recheck(self, time: float, activation: Activation) -> None:
        """Make an activation ask again, because its refusal may end at this time."""
        if activation.state == WAITING and activation.refusal is not None:
            activation.refusal.recheck = NEVER
            self.state.asking[activation] = None

    def on_patience(self, time: float, owner: tuple[Group, Activation]) -> None:
        """Make the activations that wait in a group ask again, because a rival's patience has ended (L16)."""
        self.state.dirty[owner[0].root()] = None

    def on_expire(self, time: float, spike: Spike) -> None:
        """Make holders that are not ready yet give up a spike that is too old for them (L14)."""
        self.holdings.on_expire(time, spike)

    def on_forget(self, time: float, spike: Spike) -> None:
        """Remove a spike that is too old for every detached constraint, if nothing holds it."""
        if not (spike.is_held or spike.in_halves):
            self.holdings.entries.forget(spike)

    def on_timeout(self, time: float, run: Activation) -> None:
        """Cancel a run that has taken too long."""
        self.runs.cancel(run, "timeout")

    def on_watch(self, time: float, watch: Watch) -> None:
        """Judge an `until` condition whose spikes are old enough now (L21)."""
        watch.due = NEVER
        self.runs.judge(watch)

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
    events.Start: Parts.on_start,
    events.Stop: Parts.on_stop,
    events.Write: Parts.on_write,
    events.Store: Parts.on_store,
    events.Discard: Parts.on_discard,
    events.Emit: Parts.on_emit,
    events.Wipe: Parts.on_wipe,
    events.Finish: Parts.on_finish,
    events.AddRule: Parts.on_add_rule,
}
"""Type of an event → its handler."""

DUE: dict[Kind, Any] = {
    Kind.RIPEN: Parts.on_ripen,
    Kind.LOOK: Parts.on_look,
    Kind.RECHECK: Parts.on_recheck,
    Kind.PATIENCE: Parts.on_patience,
    Kind.EXPIRE: Parts.on_expire,
    Kind.FORGET: Parts.on_forget,
    Kind.TIMEOUT: Parts.on_timeout,
    Kind.WATCH: Parts.on_watch,
}
"""Kind of a deadline → its handler."""


def _unknown(what: str, name: str, names: Iterable[str]) -> str:
    return f"the policy has no {what} {name!r}{nearest(name, names)}"
