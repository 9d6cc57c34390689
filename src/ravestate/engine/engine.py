"""The Signal-Rule-Slot automaton as a pure state machine.

The engine has four verbs: `receive` an event, `advance` to a time, ask for the `next_deadline`, take the `effects`.
Time is an argument, in seconds from any origin. Nothing here knows a clock, a thread or a loop.

This file has the handlers of events, the outcomes of runs, and the handling of deadlines. The rest is in the layers
below, one file each: ``agenda.py``, ``slots.py``, ``matching.py``, ``conflict_sets.py``, ``holdings.py``, ``state.py``.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, get_args

from ravestate.declare.wording import said
from ravestate.engine import events, trace
from ravestate.engine.activation import RUNNING, Activation
from ravestate.engine.agenda import Agenda
from ravestate.engine.deadlines import LOOK, Deadlines, Table
from ravestate.engine.effects import Effect, Ended
from ravestate.engine.events import Event
from ravestate.engine.group import Group
from ravestate.engine.slots import ABSENT, equal
from ravestate.engine.spike import Spike
from ravestate.errors import EngineError, RuleError, RuleTimeout, UndeclaredError, nearest
from ravestate.policy.model import RulePlan, SlotPlan
from ravestate.policy.policy import Policy

OUTCOMES = get_args(events.OutcomeKind)

DEFAULT_PATIENCE = 1.0
"""The default patience of a rival under pressure, in seconds (L16)."""


class Engine(Agenda):
    """A running automaton. Any number of engines may share one policy.

    Args:
        policy: A policy from ``rs.compile``.
        patience: The patience of rivals under pressure, in seconds, unless their rule sets its own (L16).
        report_ends: Whether each run ends with an `Ended` effect.

    Example:
        >>> import ravestate as rs
        >>> from ravestate.engine.events import Start
        >>> engine = Engine(rs.compile())
        >>> engine.receive(Start(), 0.0)
        >>> engine.effects()
        []
    """

    __slots__ = (
        "__weakref__",
        "report_ends",
    )

    def __init__(self, policy: Policy, *, patience: float = DEFAULT_PATIENCE, report_ends: bool = False) -> None:
        super().__init__(policy, patience)
        self._deadlines = Deadlines(self, DEADLINES)
        self.report_ends = report_ends

    # ------------------------------------------------------------------------------------ the four verbs

    def receive(self, event: Event, now: float) -> None:
        """Handle an event at the time `now` (seconds). A time before that of an earlier call counts as the latest time.

        Raises:
            UndeclaredError: The event names a signal or slot that the policy does not have.
            EngineError: The event comes from a run that is over.
        """
        if not now >= self.now:  # NaN is neither before nor after
            if now != now:
                raise EngineError("the time is not a number of seconds: it is NaN")
        elif now > self.now:
            if self._stuck:
                self._refused.update(self._stuck)  # with time, their reasons to wait may change
                self._stuck.clear()
            if self._deadlines.earliest <= now:
                self.advance(now)
            self.now = now
        handler = HANDLERS.get(type(event))
        if handler is None:
            raise EngineError(f"{event!r} is not an event: see ravestate.engine.events")
        handler(self, event)

    def advance(self, now: float) -> None:
        """Let time pass until `now` (seconds), deadline by deadline. A repeated or early call changes nothing."""
        entry = self._deadlines.pop(now)
        while entry is not None:
            self.now = max(self.now, entry[0])
            self._deadlines.fall_due(entry)
            entry = self._deadlines.pop(now)
        self.now = max(self.now, now)

    def next_deadline(self) -> float | None:
        """Return the time (seconds) at which to call `advance` next, unless an event comes first; None for never."""
        return self._deadlines.next()

    @property
    def late_turns(self) -> int:
        """The number of deferred turns that endless loops have had in this instant, after all other rules (L23)."""
        return self._loops.late

    def effects(self) -> list[Effect]:
        """Return the effects to perform now. Call this again after performing them, until the list is empty."""
        # Reports (of spikes, ends, failures) do not end the loop: only a run to start or cancel does.
        while not self._acts:
            if self._deadlines.earliest <= self.now:
                self.advance(self.now)
            elif self._errors:
                error = self.policy.signal_of["core:error"]
                failure, lineage = self._errors.pop(0)
                self._birth(error, failure, (), self._new_group(), None, lineage)
            elif self._busy and not self.values.get(self._activity.index):
                self._set_flag(self._activity, True)
            elif self._free.new or self._free.line:
                self._start_free()
            elif self._queue or self._asking or self._dirty or self._stirred or self._refused or self._stuck:
                self._consent_round()
            elif self._settle_flags():
                pass
            elif self._loops.deferred and (turn := self._loops.next()) is not None:
                self._complete(turn, late=True)
            else:
                self._loops.rest()
                break
        out = self._out
        self._out = []
        self._acts = False
        return out

    # ------------------------------------------------------------------------------------ events

    def on_start(self, event: events.Start) -> None:
        self._birth(self.policy.signal_of["core:startup"], None, (), self._new_group(), None)

    def on_stop(self, event: events.Stop) -> None:
        self._birth(self.policy.signal_of["core:shutdown"], None, (), self._new_group(), None)

    def on_write(self, event: events.Write) -> None:
        slot = self._slot(event.slot)
        run = self._run(event.run)
        if slot.is_collection:
            self._replace(slot, event.value, run)
            return
        self._mark_write(slot, run)
        value = bool(event.value) if slot.is_flag else event.value
        if not slot.always and equal(self.read(slot.index), value):
            return
        self._change(slot, value, self._parents(run), run)

    def on_store(self, event: events.Store) -> None:
        slot = self._collection(event.slot)
        run = self._run(event.run)
        self._mark_write(slot, run)
        self._change_item(slot, event.key, event.item, run)

    def on_discard(self, event: events.Discard) -> None:
        slot = self._collection(event.slot)
        run = self._run(event.run)
        self._mark_write(slot, run)
        self._change_item(slot, event.key, ABSENT, run)

    def on_emit(self, event: events.Emit) -> None:
        signal = self.policy.signal_of.get(event.signal)
        if signal is None:
            raise UndeclaredError(self._unknown("signal", event.signal, self.policy.signals))
        run = self._run(event.run)
        if signal.keep_latest:
            self._withdraw(signal, "superseded")
        parents, group = self._origin(run)
        self._birth(signal, event.payload, parents, group, run)

    def on_wipe(self, event: events.Wipe) -> None:
        signal = self.policy.signal_of.get(event.signal)
        if signal is None:
            raise UndeclaredError(self._unknown("signal", event.signal, self.policy.signals))
        wiper = self._run(event.run)
        known = {spike for spikes in (*self.live.values(), self._watched_by) for spike in spikes}
        for spike in sorted((s for s in known if s.comes_from(signal.name)), key=lambda spike: spike.id):
            for holder in sorted(spike.holders, key=lambda holder: (holder.clause.index, holder.id)):
                if holder.state == RUNNING and holder is not wiper and holder.clause.rule.interruptible:
                    self._cancel(holder, "wiped")
            self._kill(spike, "wiped")

    def on_add_rule(self, event: events.AddRule) -> None:
        """Replace the policy by one that begins with the same rules in the same order, and has more."""
        known, plans = self.policy.rule_plans, event.policy.rule_plans
        if [plan.rule for plan in plans[: len(known)]] != [plan.rule for plan in known]:
            raise EngineError("the new policy does not extend the running one: make it with policy.with_rule(rule)")
        self.unfold_all()
        clauses = event.policy.clause_plans
        self.policy = event.policy
        self._activity = event.policy.slot_of["core:activity"]
        self._pressure = event.policy.slot_of["core:pressure"]
        for activations in self.active.values():
            for activation in activations:
                activation.clause = clauses[activation.clause.index]
        for spikes in (*self.live.values(), self._watched_by):
            for spike in spikes:
                spike.signal = event.policy.signal_plans[spike.signal.index]
        self.lacking = {
            clauses[need.clause.index].needs[need.index]: activations for need, activations in self.lacking.items()
        }
        self._watches = {clauses[clause.index]: watches for clause, watches in self._watches.items()}
        for watches in self._watches.values():
            for watch in watches.values():
                watch.clause = clauses[watch.clause.index]
        self._asking.update(self.waiting)
        for plan in plans[len(known) :]:
            for need in (need for clause in plan.clauses for need in clause.needs if need.detached):
                for spike in self.live.get(need.signal.index, ()):
                    if spike.born + need.min_age > self.now:  # a spike sets these times at its birth for older rules
                        self._deadlines.add(spike.born + need.min_age, LOOK, (need, spike))

    def on_finish(self, event: events.Finish) -> None:
        if event.kind not in OUTCOMES:
            raise EngineError(f"a run ends by one of {', '.join(OUTCOMES)}, not by {event.kind!r}")
        run = self.running.pop(event.run, None)
        if run is None:
            raise EngineError(f"run {event.run} is over, or never began")
        rule = run.clause.rule
        told = run.told
        outcome, exception = event.kind, event.exception
        reason = event.reason
        if told == "timeout":
            late = f"rule {rule.name} took longer than its timeout of {rule.timeout:g} s ({rule.rule.origin})"
            outcome, exception = "failed", RuleTimeout(late)
        elif outcome == "resigned" and run.wrote:
            outcome = "failed"
            exception = RuleError(
                f"rule {rule.name} resigned after it had written {self._names(rule.slots)}: resign before the first write"
            )
        elif told and outcome != "failed":
            outcome = told if outcome != "retired" else outcome
        # A run that is wiped before it wrote a slot has answered nothing: other rules may answer the remaining spikes.
        unheard = told == "wiped" and not run.wrote
        fired = (outcome not in ("resigned", "failed") and not unheard) or run.wrote or told == "interrupted"
        if rule.cooldown and fired:
            self.ran[rule.index] = self.now
            self._asking.update(
                (a, None) for a in self.waiting if rule.name in a.waits_for or a.clause.rule is rule
            )  # the rule's utility is lower now
        spikes = run.stands_on
        for clause in rule.until:
            watch = self._watches[clause].pop(run)
            for spike in filter(None, watch.spikes):
                self._unwatch(watch, spike)
            if not self._watches[clause]:
                del self._watches[clause]
        if fired:
            self._consume(run)
        else:
            self._relinquish(run, spikes)
            self._substitute(run)
        if self.tracer is not None:
            text = reason or (said(exception) if exception is not None else "")
            self.tracer(trace.Settled(self.now, run.id, rule.name, outcome, text, fired, exception))
        if self.report_ends:
            self._out.append(Ended(run.id, rule.name, outcome, fired))
        on_error = event.kind == "failed" and any(
            spike is not None and spike.comes_from("core:error") for spike in run.spikes
        )
        self._end(run)
        if event.kind == "retired":
            self._retire(rule)
        if outcome == "failed":
            failure = exception or RuleError(f"rule {rule.name} failed")
            self._fail(rule, failure, signal=not on_error, lineage=self._loops.lineage(run))

    def _slot(self, name: str) -> SlotPlan:
        slot = self.policy.slot_of.get(name)
        if slot is None:
            raise UndeclaredError(self._unknown("slot", name, self.policy.slots))
        return slot

    def _collection(self, name: str) -> SlotPlan:
        slot = self._slot(name)
        if not slot.is_collection:
            raise EngineError(f"{name} is not a collection: use Write({name!r}, value)")
        return slot

    def _run(self, number: int | None) -> Activation | None:
        if number is None:
            return None
        run = self.running.get(number)
        if run is None:
            raise EngineError(f"run {number} is over, or never began")
        return run

    def _unknown(self, what: str, name: str, names: Iterable[str]) -> str:
        return f"the policy has no {what} {name!r}{nearest(name, names)}"

    def _names(self, slots: Iterable[int]) -> str:
        return ", ".join(self.policy.slot_plans[slot].name for slot in slots)

    # ------------------------------------------------------------------------------------ outcomes

    def _consume(self, run: Activation) -> None:
        """Settle a run as Done (L18): consume its slots in its groups; make their other writers give up the spikes."""
        rule = run.clause.rule
        if rule.slots:
            groups = _roots(run)
            for group in groups:
                if self.tracer is not None:
                    group.note(rule.slots, rule.name, run.id)
                for slot in rule.slots:
                    group.take(slot, None)
            for group in groups:
                for other in list(group.members):
                    if (
                        other is not run
                        and other.state < RUNNING
                        and not other.clause.rule.slotset.isdisjoint(rule.slotset)
                    ):
                        self._lose(other, self._of_group(other, group), "consumed", run)
                for spike in list(group.entries) if group.entries else ():
                    for half in self.halves_of(spike):
                        if not half.slotset.isdisjoint(rule.slotset):
                            self._drop(spike, half)
                self._dirty[group] = None

    def _relinquish(self, run: Activation, spikes: tuple[Spike, ...]) -> None:
        """Settle Resign, or Error before a write (L18): free the run's slots, and make its rule give up `spikes`."""
        for group in _roots(run):
            for slot in run.clause.rule.slots:
                group.free(slot, run)
            self._dirty[group] = None
        self._give_up(run, spikes, "resigned")

    def _retire(self, rule: RulePlan) -> None:
        """Remove a rule from the context (L18)."""
        self.unfold_all()
        self.retired.add(rule.index)
        for activation in list(self.active.get(rule.index, ())):
            if activation.state < RUNNING:
                self._end(activation, "retired")
        self._asking.update(self.waiting)  # these may have waited for signals of the retired rule


DEADLINES: Table = (
    (lambda engine, time, activation: activation.ripens == time, Engine.on_ripen),  # RIPEN
    (lambda engine, time, looking: engine.is_live(looking[1]), Engine.on_look),  # LOOK
    (lambda engine, time, activation: activation.recheck == time, Engine.on_recheck),  # RECHECK
    (Engine.is_pressed, Engine.on_patience),  # PATIENCE
    (lambda engine, time, spike: bool(spike.holders) or engine.is_live(spike), Engine.on_expire),  # EXPIRE
    (lambda engine, time, spike: engine.is_live(spike), Engine.on_forget),  # FORGET
    (lambda engine, time, run: run.deadline == time, Engine.on_timeout),  # TIMEOUT
    (lambda engine, time, watch: watch.due == time and watch.run.state == RUNNING, Engine.on_watch),  # WATCH
)
"""For each kind of deadline, in the order of `Kind`: whether an entry still counts, and what to do when it is due."""


def _roots(run: Activation) -> list[Group]:
    """Return the groups to which the run's groups belong now, each once."""
    return list(dict.fromkeys(group.root() for group in run.groups))


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
