"""The Signal-Rule-Slot automaton as a pure state machine.

Four verbs: `receive` an event, `advance` to a time, ask for the `next_deadline`, take the `effects`.
Time is an argument, in seconds from any origin. Nothing in here knows a clock, a thread or a loop.

An instant is settled in waves, each one call of `effects`:

1. rules that exclude nobody start at once;
2. when none of these is left (those that ended without waiting have reported by then), ready writers
   ask for consent, the greatest utility first (``consent.py``);
3. when nobody may start any more, the built-in flags are brought up to date.

So whoever waits is asked again in the same instant in which a classifier ends, and never before all that
could end in this instant has ended.
"""

from __future__ import annotations

import copy
from collections.abc import Iterable, Mapping
from types import MappingProxyType
from typing import Any

from ravestate.declare.condition import Holds
from ravestate.declare.core import RuleFailure
from ravestate.declare.slot import Entry
from ravestate.engine import events, trace
from ravestate.engine.activation import NEVER, Activation, State, Step
from ravestate.engine.consent import Refusal, ask, stalemate
from ravestate.engine.deadlines import Deadlines, Entry, Kind
from ravestate.engine.effects import Cancel, CancelReason, Effect, Ended, Failed, Run, Spiked
from ravestate.engine.events import Event
from ravestate.engine.group import Group
from ravestate.engine.horizon import FIRM, Horizon
from ravestate.engine.spike import Spike
from ravestate.engine.trace import Tracer
from ravestate.engine.watch import Watch
from ravestate.errors import EngineError, RuleError, RuleTimeout, UndeclaredError
from ravestate.policy.plan import Clause, Need, RulePlan, SignalPlan, SlotPlan
from ravestate.policy.policy import Policy

__all__ = ["DEFAULT_PATIENCE", "Engine"]

DEFAULT_PATIENCE = 1.0
"""Seconds that a rival under pressure has to become ready (L16)."""

PASSIVE = (int, float, str, bytes, bool, type(None))
"""Types of which a context needs no copy of its own."""


class Engine:
    """One running automaton over a policy that it shares with others.

    Args:
        policy: What ``rs.compile`` made.
        patience: Seconds that rivals have under pressure where their rule does not say (L16).
        report_ends: Whether each settled run makes an `Ended` effect.

    Example:
        >>> import ravestate as rs
        >>> from ravestate.engine.events import Start
        >>> engine = Engine(rs.compile())
        >>> engine.receive(Start(), 0.0)
        >>> engine.effects()
        []
    """

    __slots__ = (
        "_activations",
        "_activity",
        "_asking",
        "_blamed",
        "_busy",
        "_deadlines",
        "_dirty",
        "_free",
        "_groups",
        "_out",
        "_pressure",
        "_spikes",
        "_stirred",
        "_watches",
        "active",
        "dropped",
        "gated",
        "lacking",
        "live",
        "now",
        "patience",
        "policy",
        "ran",
        "report_ends",
        "retired",
        "running",
        "tracer",
        "values",
        "waiting",
        "watched",
    )

    def __init__(self, policy: Policy, *, patience: float = DEFAULT_PATIENCE, report_ends: bool = False) -> None:
        self.policy = policy
        self.patience = patience
        self.report_ends = report_ends
        self.tracer: Tracer | None = None
        self.now = 0.0
        self.values: dict[int, Any] = {}
        """Slots that were written or read: index to value."""
        self.live: dict[int, dict[Spike, None]] = {}
        """Live spikes by signal, oldest first."""
        self.active: dict[int, dict[Activation, None]] = {}
        """Activations that hold a spike or run, by rule."""
        self.lacking: dict[Need, dict[Activation, None]] = {}
        """Activations that hold something, but nothing for this need."""
        self.gated: dict[Activation, None] = {}
        """Activations that hold everything, but a predicate on a slot is false."""
        self.running: dict[int, Activation] = {}
        self.waiting: dict[Activation, None] = {}
        """Ready activations that were refused consent."""
        self.retired: set[int] = set()
        self.ran: dict[int, float] = {}
        """When rules with a cooldown ran last."""
        self.dropped: dict[str, int] = {}
        """How many spikes overflowed, by signal (L23)."""
        self.watched: dict[str, int] = {}
        """Signals whose spikes are reported, with how many want that."""
        self._free: list[Activation] = []  # ready, and in need of nobody's consent
        self._asking: dict[Activation, None] = {}  # ready, and not yet asked
        self._dirty: dict[Group, None] = {}  # groups in which something ended
        self._stirred = False  # something ended that those who wait on patience may have waited for
        self._watches: dict[Clause, dict[Activation, Watch]] = {}
        self._out: list[Effect] = []
        self._blamed: set[int] = set()  # predicates whose failure has been reported
        self._deadlines = Deadlines(self._stands)
        self._activations = 0
        self._spikes = 0
        self._groups = 0
        self._busy = 0  # activations of rules that are not in the background
        self._activity = policy.slot_of["core:activity"]
        self._pressure = policy.slot_of["core:pressure"]

    # ------------------------------------------------------------------------------------ the four verbs

    def receive(self, event: Event, now: float) -> None:
        """Take an event at a time (seconds, not before the last one).

        Raises:
            UndeclaredError: It names a signal or slot that the policy does not have.
            EngineError: It comes from a run that is over.
        """
        if now > self.now:
            self.advance(now)
        HANDLERS[type(event)](self, event)

    def advance(self, now: float) -> None:
        """Let time pass until `now`, deadline by deadline. Doing so twice, or too early, changes nothing."""
        entry = self._deadlines.pop(now)
        while entry is not None:
            self.now = max(self.now, entry[0])
            self._due(entry)
            entry = self._deadlines.pop(now)
        self.now = max(self.now, now)

    def next_deadline(self) -> float | None:
        """When to call `advance` next (seconds), if nothing else happens before."""
        return self._deadlines.next()

    def effects(self) -> list[Effect]:
        """What is to be done now; ask again after doing it, until there is nothing."""
        while not self._out:
            if self._busy and not self.read(self._activity.index):
                self._change(self._activity, True, (), None)
            elif self._free:
                self._start_free()
            elif self._asking or self._dirty or self._stirred:
                self._consent_round()
            elif not self._settle_flags():
                break
        out = self._out
        self._out = []
        return out

    # ------------------------------------------------------------------------------------ events

    def _on_start(self, event: events.Start) -> None:
        self._birth(self.policy.signal_of["core:startup"], None, (), self._new_group(), None)

    def _on_stop(self, event: events.Stop) -> None:
        self._birth(self.policy.signal_of["core:shutdown"], None, (), self._new_group(), None)

    def _on_write(self, event: events.Write) -> None:
        slot = self._slot(event.slot)
        run = self._run(event.run)
        if slot.slot.kind == "collection":
            self._replace(slot, event.value, run)
            return
        self._mark_write(slot, run)
        old = self.read(slot.index)
        if not slot.slot.always and _equal(old, event.value):
            return
        self._change(slot, event.value, self._parents(run), run)

    def _on_store(self, event: events.Store) -> None:
        slot = self._slot(event.slot)
        run = self._run(event.run)
        self._mark_write(slot, run)
        self._change_item(slot, event.key, event.item, run, self._origin(run))

    def _on_discard(self, event: events.Discard) -> None:
        slot = self._slot(event.slot)
        run = self._run(event.run)
        self._mark_write(slot, run)
        self._change_item(slot, event.key, ABSENT, run, self._origin(run))

    def _on_emit(self, event: events.Emit) -> None:
        signal = self.policy.signal_of.get(event.signal)
        if signal is None:
            raise UndeclaredError(self._unknown("signal", event.signal, self.policy.signals))
        run = self._run(event.run)
        if signal.keep_latest:
            self._withdraw(signal, "superseded")
        parents, group = self._origin(run)
        self._birth(signal, event.payload, parents, group, run)

    def _on_wipe(self, event: events.Wipe) -> None:
        signal = self.policy.signal_of.get(event.signal)
        if signal is None:
            raise UndeclaredError(self._unknown("signal", event.signal, self.policy.signals))
        wiper = self._run(event.run)
        wiped = {spike.id for spike in self.live.get(signal.index, ())}
        doomed = [s for spikes in self.live.values() for s in spikes if s.has_ancestor(wiped)] if wiped else []
        for spike in doomed:
            for holder in list(spike.holders):
                if holder.state == State.RUNNING and holder is not wiper and holder.clause.rule.interruptible:
                    self._cancel(holder, "wiped")
            self._kill(spike, "wiped")

    def _on_add_rule(self, event: events.AddRule) -> None:
        """Replace the policy by one that has the same rules in the same order, and more."""
        clauses = event.policy.clause_plans
        self.policy = event.policy
        self._activity = event.policy.slot_of["core:activity"]
        self._pressure = event.policy.slot_of["core:pressure"]
        for activations in self.active.values():
            for activation in activations:
                activation.clause = clauses[activation.clause.index]
        for spikes in self.live.values():
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

    def _on_finish(self, event: events.Finish) -> None:
        run = self.running.pop(event.run, None)
        if run is None:
            raise EngineError(f"run {event.run} is over, or never was")
        rule = run.clause.rule
        told = run.told
        outcome, exception = event.kind, event.exception
        reason = event.reason
        if told == "timeout":
            outcome, exception = "failed", RuleTimeout(_overdue(rule))
        elif outcome == "resigned" and run.wrote:
            outcome = "failed"
            exception = RuleError(
                f"rule {rule.name} resigned after it had written {self._names(rule.slots)}: resign before the first write"
            )
        elif told and outcome != "failed":
            outcome = told if outcome != "retired" else outcome
        fired = outcome not in ("resigned", "failed") or run.wrote or told in ("interrupted", "wiped")
        if rule.cooldown and fired:
            self.ran[rule.index] = self.now
        spikes = run.firm_spikes()
        for clause in rule.until:
            self._watches.get(clause, {}).pop(run, None)
            if not self._watches.get(clause, True):
                del self._watches[clause]
        if fired:
            self._consume(run, spikes)
        else:
            self._relinquish(run, spikes)
        if self.tracer is not None:
            text = reason or (str(exception) if exception is not None else "")
            self.tracer(trace.Settled(self.now, run.id, rule.name, outcome, text, fired))
        if self.report_ends:
            self._out.append(Ended(run.id, rule.name, outcome, fired))
        on_error = any(s is not None and s.signal.name == "core:error" for s in run.spikes)
        self._end(run)
        if event.kind == "retired":
            self._retire(rule)
        if outcome == "failed":
            self._fail(rule, exception or RuleError(f"rule {rule.name} failed"), signal=not on_error)

    # ------------------------------------------------------------------------------------ looking up

    def read(self, slot: int) -> Any:
        """The value of a slot, by its number."""
        try:
            return self.values[slot]
        except KeyError:
            default = self.policy.slot_plans[slot].slot.default
            if not isinstance(default, PASSIVE) and not isinstance(default, MappingProxyType):
                default = copy.deepcopy(default)  # contexts share no state
            self.values[slot] = default
            return default

    def effective(self, clause: Clause) -> float:
        """The effective utility of a clause now (L9): utility x weight x recovery, in nats."""
        cooldown = clause.rule.cooldown
        if cooldown:
            ran = self.ran.get(clause.rule.index)
            if ran is not None and self.now - ran < cooldown:
                return clause.base * ((self.now - ran) / cooldown)
        return clause.base

    def recovery(self, clause: Clause) -> tuple[float, float, float]:
        """Effective utility (nats), its slope (nats per second), and when the rule has recovered (seconds)."""
        rule = clause.rule
        ran = self.ran.get(rule.index)
        if not rule.cooldown or ran is None or self.now - ran >= rule.cooldown:
            return clause.base, 0.0, -NEVER
        return self.effective(clause), clause.base / rule.cooldown, ran + rule.cooldown

    def order(self, activation: Activation) -> tuple[float, int, int]:
        """By what ready activations are asked: the greatest utility, then the first declared, then the oldest."""
        return (-self.effective(activation.clause), activation.clause.index, activation.id)

    def holds(self, slot: SlotPlan, guard: Holds, rule: RulePlan) -> bool:
        """Whether a predicate on a slot's present value is true; one that fails is false, and is reported."""
        return self._test(guard.predicate, self.read(slot.index), rule)

    def live_spike(self, need: Need) -> Spike | None:
        """A live spike, not given up by the rule and not consumed for it, that could meet a need."""
        return next((spike for spike in self.live.get(need.signal.index, ()) if self._fits(need, spike)), None)

    def _fits(self, need: Need, spike: Spike) -> bool:
        rule = need.clause.rule
        if spike.born + need.max_age < self.now:
            return False
        if not need.detached:
            if spike.refused is not None and rule.index in spike.refused:
                return False
            if spike.claims is not None and rule.index in spike.claims:
                return False
            taken = spike.group.root().taken
            if any(slot in taken and taken[slot] is None for slot in rule.slots):
                return False
            if need.clause.cyclic and spike.descends_from(rule.index):
                return False
        return all(self._test(predicate, spike.payload, rule) for predicate in need.predicates)

    def _slot(self, name: str) -> SlotPlan:
        slot = self.policy.slot_of.get(name)
        if slot is None:
            raise UndeclaredError(self._unknown("slot", name, self.policy.slots))
        return slot

    def _run(self, number: int | None) -> Activation | None:
        if number is None:
            return None
        run = self.running.get(number)
        if run is None:
            raise EngineError(f"run {number} is over, or never was")
        return run

    def _unknown(self, what: str, name: str, names: Iterable[str]) -> str:
        from ravestate.errors import nearest

        return f"the policy has no {what} {name!r}{nearest(name, names)}"

    def _names(self, slots: Iterable[int]) -> str:
        return ", ".join(self.policy.slot_plans[slot].name for slot in slots)

    def _test(self, predicate: Any, value: Any, rule: RulePlan) -> bool:
        try:
            return bool(predicate(value))
        except Exception as exception:  # a predicate is the designer's code: it may fail in any way
            if id(predicate) not in self._blamed:
                self._blamed.add(id(predicate))
                self._fail(rule, exception, signal=True)
            return False

    # ------------------------------------------------------------------------------------ slots

    def _mark_write(self, slot: SlotPlan, run: Activation | None) -> None:
        if run is not None:
            if slot.index not in run.clause.rule.slotset:
                raise UndeclaredError(f"rule {run.clause.rule.name} writes {slot.name} without writes={slot.name}")
            run.wrote = True

    def _change(self, slot: SlotPlan, value: Any, parents: tuple[Spike, ...], run: Activation | None) -> None:
        """Give a value or flag slot its value, and signal (L2, L13)."""
        self.values[slot.index] = value
        if self.tracer is not None:
            self.tracer(trace.Set(self.now, slot.name, value, 0 if run is None else run.id))
        if slot.signals[0].keep_latest:
            for signal in slot.signals:
                self._withdraw(signal, "superseded")
        raised = slot.signals
        if slot.slot.kind == "flag":
            raised = (slot.signals[0], slot.signals[1] if value else slot.signals[2])
        if any(s.listeners or s.watchers or s.name in self.watched for s in raised) or self.tracer is not None:
            group = self._group_of(parents)
            for signal in raised:
                self._birth(signal, value, parents, group, run)
        self._regate()

    def _change_item(
        self, slot: SlotPlan, key: str, item: Any, run: Activation | None, origin: tuple[tuple[Spike, ...], Group]
    ) -> None:
        old: Mapping[str, Any] = self.read(slot.index)
        known = old.get(key, ABSENT)
        if known is item or (known is not ABSENT and item is not ABSENT and _equal(known, item)):
            return
        items = dict(old)
        changed, added, removed = slot.signals
        raised = (changed,)
        if item is ABSENT:
            items.pop(key, None)
            raised = (changed, removed)
        else:
            if known is ABSENT:
                raised = (changed, added)
            items[key] = item
        self.values[slot.index] = MappingProxyType(items)
        if self.tracer is not None:
            self.tracer(trace.Set(self.now, slot.name, items, 0 if run is None else run.id))
        entry = Entry(key, known if item is ABSENT else item)
        for signal in raised:
            if signal.keep_latest:
                self._withdraw(signal, "superseded")
            self._birth(signal, entry, origin[0], origin[1], run)
        self._regate()

    def _replace(self, slot: SlotPlan, value: Mapping[str, Any], run: Activation | None) -> None:
        """Give a collection all its items at once: as if each difference had been written."""
        if not isinstance(value, Mapping):
            raise RuleError(f"{slot.name} is a collection: write a mapping of keys to items, not {value!r}")
        self._mark_write(slot, run)
        old: Mapping[str, Any] = self.read(slot.index)
        for key in [*(k for k in old if k not in value), *value]:
            self._change_item(slot, key, value.get(key, ABSENT), run, self._origin(run))

    def _regate(self) -> None:
        """A slot has changed: predicates on slots may have become true, or false."""
        if self.gated:
            for activation in list(self.gated):
                del self.gated[activation]
                self._update(activation)
        if self.waiting:
            for activation in self.waiting if self.policy.guarded else ():
                self._asking[activation] = None

    # ------------------------------------------------------------------------------------ spikes

    def _parents(self, run: Activation | None) -> tuple[Spike, ...]:
        return () if run is None or run.clause.rule.detached else run.firm_spikes()

    def _origin(self, run: Activation | None) -> tuple[tuple[Spike, ...], Group]:
        parents = self._parents(run)
        return parents, self._group_of(parents)

    def _new_group(self) -> Group:
        self._groups += 1
        return Group(self._groups)

    def _group_of(self, parents: tuple[Spike, ...]) -> Group:
        """The causal group of a spike with these parents: theirs merge (L11)."""
        if not parents:
            return self._new_group()
        root = parents[0].group.root()
        for parent in parents[1:]:
            other = parent.group.root()
            if other is not root:
                root = self._merge(root, other)
        return root

    def _merge(self, one: Group, other: Group) -> Group:
        root, merged = (one, other) if one.id < other.id else (other, one)
        root.absorb(merged)
        if self.tracer is not None:
            self.tracer(trace.Merged(self.now, merged.id, root.id))
        done = {slot for slot, holder in root.taken.items() if holder is None}
        for activation in list(root.members):
            if activation.state < State.RUNNING and not activation.clause.rule.slotset.isdisjoint(done):
                self._lose(activation, self._of_group(activation, root), "consumed")
        self._dirty.pop(merged, None)
        self._dirty[root] = None
        return root

    def _birth(
        self,
        signal: SignalPlan,
        payload: Any,
        parents: tuple[Spike, ...],
        group: Group,
        run: Activation | None,
    ) -> None:
        """A spike is born, and offered to whoever lacks it (L11, L12)."""
        self._spikes += 1
        source = 0 if run is None else run.id
        if self.tracer is not None:
            ids = tuple(parent.id for parent in parents)
            self.tracer(trace.Born(self.now, self._spikes, signal.name, group.id, ids, source, payload))
        if self.watched and signal.name in self.watched:
            self._out.append(Spiked(signal.name, payload))
        if not signal.listeners and not (signal.watchers and self._watches):
            return
        rule = -1 if run is None or run.clause.rule.detached else run.clause.rule.index
        spike = Spike(self._spikes, signal, payload, self.now, group, parents, source, rule)
        live = self.live.get(signal.index)
        if live is None:
            live = self.live[signal.index] = {}
        live[spike] = None
        if len(live) > signal.limit:
            self.dropped[signal.name] = self.dropped.get(signal.name, 0) + 1
            self._kill(next(iter(live)), "overflow")
        if signal.watchers and self._watches:
            self._watch(spike)
        for need in signal.listeners:
            self._offer(need, spike)
        if signal.retain >= 0 and signal.retain != NEVER:
            self._deadlines.add(self.now + signal.retain, Kind.FORGET, spike)
        if not spike.holders:
            self._forget(spike)

    def _offer(self, need: Need, spike: Spike) -> None:
        """Offer a new spike to every activation that lacks it, oldest first, then to the one in stand-by."""
        clause = need.clause
        rule = clause.rule
        if self.retired and rule.index in self.retired:
            return
        for predicate in need.predicates:
            if not self._test(predicate, spike.payload, rule):
                return
        if not need.detached:
            if clause.cyclic and spike.descends_from(rule.index):
                return
            taken = spike.group.taken
            if taken:
                for slot in rule.slots:
                    if slot in taken and taken[slot] is None:
                        return
        lacking = self.lacking.get(need)
        if lacking:
            for activation in sorted(lacking, key=_age) if len(lacking) > 1 else tuple(lacking):
                if need.kin != need.bit and not self._coherent(activation, need, spike):
                    continue
                if activation.missing & need.bit:  # still: an earlier one may have changed it
                    self._acquire(activation, need, spike)
                    self._update(activation)
        if need.detached and clause.asks_detached:
            return  # it is looked at; it makes no activation of its own
        self._activations += 1
        activation = Activation(self._activations, clause)
        active = self.active.get(rule.index)
        if active is None:
            active = self.active[rule.index] = {}
        active[activation] = None
        if not rule.background:
            self._busy += 1
        if len(clause.needs) > 1:
            for other in clause.needs:
                self.lacking.setdefault(other, {})[activation] = None
        self._acquire(activation, need, spike)
        if len(clause.needs) > 1:
            self._look(activation)
        self._update(activation)

    def _coherent(self, activation: Activation, need: Need, spike: Spike) -> bool:
        held = activation.held(need.kin & ~need.bit)
        return held is None or held.group.root() is spike.group.root()

    def _look(self, activation: Activation) -> None:
        """Let an activation look at what is there already: detached needs take what is live, the newest that is old
        enough; and the same spike may meet two constraints of one clause."""
        for need in activation.clause.needs:
            if not need.bit & activation.missing:
                continue
            live = self.live.get(need.signal.index)
            if not live:
                continue
            if need.detached:
                best: Spike | None = None
                for spike in reversed(live):
                    if self._fits(need, spike):
                        best = spike  # too young ones: the oldest of them ripens first
                        if spike.born + need.min_age <= self.now:
                            break
                if best is not None:
                    self._acquire(activation, need, best)

    def _rematch(self, activation: Activation, need: Need) -> None:
        """An activation has lost a spike: let it take another that is live, the oldest first (L16 i)."""
        if need.detached:
            self._look(activation)
        elif need.kin == need.bit:
            for spike in self.live.get(need.signal.index, ()):
                if self._fits(need, spike):
                    self._acquire(activation, need, spike)
                    return

    def _acquire(self, activation: Activation, need: Need, spike: Spike) -> None:
        activation.spikes[need.index] = spike
        activation.missing &= ~need.bit
        spike.holders[activation] = None
        if not need.detached:
            group = spike.group if spike.group.into is None else spike.group.root()
            group.members[activation] = group.members.get(activation, 0) + 1
        if len(activation.spikes) > 1:
            lacking = self.lacking.get(need)
            if lacking is not None:
                lacking.pop(activation, None)
                if not lacking:
                    del self.lacking[need]
        if self.tracer is not None:
            clause = activation.clause
            lacks = tuple(n.signal.name for n in clause.needs if n.bit & activation.missing)
            self.tracer(
                trace.Held(
                    self.now, activation.id, clause.rule.name, clause.number, spike.id, spike.signal.name, lacks
                )
            )

    def _update(self, activation: Activation) -> None:
        """Its spikes have changed, or become old enough: it may be ready (L14), or wait for an age."""
        clause = activation.clause
        if not activation.missing:
            ripens = -NEVER
            for need in clause.needs:
                if need.min_age:
                    spike = activation.spikes[need.index]
                    ripens = max(ripens, spike.born + need.min_age)  # type: ignore[union-attr]  # nothing is missing
            if ripens <= self.now:
                activation.ripens = NEVER
                if not clause.guards or all(self.holds(s, g, clause.rule) for s, g in clause.guards):
                    activation.expires = NEVER
                    activation.pressed = NEVER
                    activation.step(Step.COMPLETE)
                    if clause.rule.slots and clause.firm_bits:
                        self._asking[activation] = None
                    else:
                        self._free.append(activation)
                    return
                self.gated[activation] = None
            elif activation.ripens != ripens:
                activation.ripens = ripens
                self._deadlines.add(ripens, Kind.RIPEN, activation)
        expires = NEVER
        for need in clause.needs:
            spike = activation.spikes[need.index]
            if spike is not None and need.max_age != NEVER:
                expires = min(expires, spike.born + need.max_age)
        if expires != activation.expires:
            activation.expires = expires
            if expires != NEVER:
                self._deadlines.add(expires, Kind.EXPIRE, activation)

    def _release(self, activation: Activation, need: Need, reason: str) -> None:
        """Take a spike from an activation."""
        spike = activation.spikes[need.index]
        if spike is None:
            return
        activation.spikes[need.index] = None
        activation.missing |= need.bit
        if not need.detached:
            group = spike.group.root()
            count = group.members.get(activation, 0)
            if count > 1:
                group.members[activation] = count - 1
            else:
                group.members.pop(activation, None)
            if group.interested:
                self._dirty[group] = None
        if all(other is not spike for other in activation.spikes):
            spike.holders.pop(activation, None)
            if not spike.holders:
                self._forget(spike)
        if reason and self.tracer is not None:
            self.tracer(
                trace.GaveUp(
                    self.now, activation.id, activation.clause.rule.name, spike.id, spike.signal.name, reason
                )
            )

    def _lose(self, activation: Activation, needs: Iterable[Need], reason: str) -> None:
        """An activation gives spikes up; without any left it is no more."""
        needs = [need for need in needs if not need.bit & activation.missing]
        if not needs:
            return
        clause = activation.clause
        for need in needs:
            self._release(activation, need, reason)
        left = clause.all_bits & ~activation.missing
        if not left or (clause.asks_detached and not left & clause.firm_bits):
            self._end(activation)
            return
        self._unready(activation)
        for need in needs:
            self.lacking.setdefault(need, {})[activation] = None
        for need in needs:
            if need.bit & activation.missing:
                self._rematch(activation, need)
        self._update(activation)

    def _unready(self, activation: Activation) -> None:
        activation.step(Step.LOSE)
        activation.ripens = NEVER
        if activation.interests:
            self._lose_interest(activation)
        self._asking.pop(activation, None)
        self.gated.pop(activation, None)

    def _end(self, activation: Activation) -> None:
        """An activation is no more: nothing of it is left."""
        activation.step(Step.END)
        clause = activation.clause
        if len(clause.needs) > 1:
            for need in clause.needs:
                if need.bit & activation.missing:
                    lacking = self.lacking.get(need)
                    if lacking is not None:
                        lacking.pop(activation, None)
                        if not lacking:
                            del self.lacking[need]
        for need in clause.needs:
            self._release(activation, need, "")
        if activation.interests:
            self._lose_interest(activation)
        self._asking.pop(activation, None)
        self.gated.pop(activation, None)
        activation.expires = activation.ripens = activation.pressed = NEVER
        activation.recheck = activation.deadline = NEVER
        activation.blockers = activation.groups = ()
        active = self.active[clause.rule.index]
        del active[activation]
        if not active:
            del self.active[clause.rule.index]
            self._stirred = True
        if not clause.rule.background:
            self._busy -= 1

    def _forget(self, spike: Spike) -> None:
        """Nobody holds the spike: it is gone, unless detached needs may still look at it."""
        signal = spike.signal
        if signal.retain >= 0 and spike.born + signal.retain > self.now:
            return
        live = self.live.get(signal.index)
        if live is not None:
            live.pop(spike, None)
            if not live:
                del self.live[signal.index]
        if spike.group.root().interested:
            self._dirty[spike.group.root()] = None

    def _kill(self, spike: Spike, reason: str) -> None:
        """Withdraw a spike: activations give it up (L20); a run that stands on it keeps what it has."""
        if self.tracer is not None:
            self.tracer(trace.Dropped(self.now, spike.id, spike.signal.name, reason))
        live = self.live.get(spike.signal.index)
        if live is not None:
            live.pop(spike, None)
            if not live:
                del self.live[spike.signal.index]
        for holder in list(spike.holders):
            if holder.state < State.RUNNING:
                self._lose(holder, self._of_spike(holder, spike), "withdrawn")

    def _withdraw(self, signal: SignalPlan, reason: str) -> None:
        live = self.live.get(signal.index)
        if live:
            for spike in list(live):
                self._kill(spike, reason)

    def _of_spike(self, activation: Activation, spike: Spike) -> list[Need]:
        return [need for need in activation.clause.needs if activation.spikes[need.index] is spike]

    def _of_group(self, activation: Activation, group: Group) -> list[Need]:
        found: list[Need] = []
        for need in activation.clause.needs:
            spike = activation.spikes[need.index]
            if spike is not None and not need.detached and spike.group.root() is group:
                found.append(need)
        return found

    # ------------------------------------------------------------------------------------ waves

    def _start_free(self) -> None:
        free = self._free
        self._free = []
        for activation in free:
            if activation.state != State.READY:
                continue
            if not self._guarded(activation):
                continue
            rule = activation.clause.rule
            if not rule.slots:
                other = self._claimed(activation)
                if other is not None:
                    self._refuse(activation, Refusal.by(other, activation))
                    continue
            self._start(activation)

    def _claimed(self, activation: Activation) -> Activation | None:
        """A run of the same rule on one of the same spikes: all that excludes a rule without slots (L10)."""
        for spike in activation.firm_spikes():
            if spike.claims is not None:
                other = spike.claims.get(activation.clause.rule.index)
                if other is not None:
                    return other
        return None

    def _guarded(self, activation: Activation) -> bool:
        clause = activation.clause
        if clause.guards and not all(self.holds(s, g, clause.rule) for s, g in clause.guards):
            self._unready(activation)
            self._update(activation)
            return False
        return True

    def _consent_round(self) -> None:
        asking = dict(self._asking)
        for group in self._dirty:
            asking.update(group.interested)
        if self._stirred:
            asking.update((a, None) for a in self.waiting if a.speculative)
        self._asking.clear()
        self._dirty.clear()
        self._stirred = False
        for activation in sorted(asking, key=self.order) if len(asking) > 1 else asking:
            if activation.state not in (State.READY, State.WAITING) or not self._guarded(activation):
                continue
            if not activation.clause.rule.slots:
                if self._claimed(activation) is None:
                    self._start(activation)
                continue
            refusal = ask(self, activation)
            if not refusal:
                self._start(activation)
                continue
            for group, rival, member in refusal.pressed:
                self._press(group, rival, member, activation)
            self._refuse(activation, refusal)
            activation.recheck = refusal.recheck
            if refusal.recheck != NEVER:
                self._deadlines.add(refusal.recheck, Kind.RECHECK, activation)
        if self.waiting and not self._out and not self._free:
            best = stalemate(self)
            if best is not None:
                self._start(best)

    def _refuse(self, activation: Activation, refusal: Refusal) -> None:
        activation.step(Step.REFUSE)
        self._lose_interest(activation)
        self.waiting[activation] = None
        names = tuple(refusal.names)
        changed = activation.waits_for != names
        activation.waits_for = names
        activation.blockers = tuple(refusal.blockers)
        activation.speculative = bool(refusal.pressed)
        activation.interests = tuple(refusal.interests)
        for group in activation.interests:
            group.interested[activation] = None
        if changed and self.tracer is not None:
            until = None if activation.blockers else self.patience_of_rivals(activation)
            self.tracer(trace.Waits(self.now, activation.id, activation.clause.rule.name, names, until))

    def _lose_interest(self, activation: Activation) -> None:
        """It waits no longer: what happens in those groups does not concern it."""
        self.waiting.pop(activation, None)
        for group in activation.interests:
            group.root().interested.pop(activation, None)
        activation.interests = ()

    def patience_of_rivals(self, activation: Activation) -> float | None:
        """Until when, at the latest, the rivals that a waiting activation waits for have patience (seconds)."""
        names = activation.waits_for
        times: list[float] = []
        for group in activation.firm_groups():
            times += [m.pressed for m in group.members if m.clause.rule.name in names and m.pressed != NEVER]
            clauses = self.policy.clause_plans
            times += [t for c, t in (group.pressed or {}).items() if clauses[c].rule.name in names]
        return max(times, default=None)

    def _press(self, group: Group, rival: Clause, member: Activation | None, by: Activation) -> None:
        patience = self.patience if rival.rule.patience is None else rival.rule.patience
        until = self.now + patience
        if member is not None:
            if member.pressed != NEVER:
                return
            member.pressed = until
            self._deadlines.add(until, Kind.PATIENCE, member)
        else:
            if group.pressed is None:
                group.pressed = {}
            if rival.index in group.pressed:
                return
            group.pressed[rival.index] = until
            self._deadlines.add(until, Kind.STANDBY, (group, rival.index, until))
        if self.tracer is not None:
            missing = rival.all_bits if member is None else member.missing
            lacks = tuple(n.signal.name for n in rival.needs if n.bit & missing)
            self.tracer(trace.Pressed(self.now, rival.rule.name, by.clause.rule.name, lacks, until))

    def _start(self, activation: Activation) -> None:
        """It takes its slots in its groups, and its function runs (L17)."""
        activation.step(Step.GRANT)
        clause = activation.clause
        rule = clause.rule
        if activation.interests:
            self._lose_interest(activation)
        activation.recheck = NEVER
        activation.blockers = activation.waits_for = ()
        activation.since = self.now
        if rule.slots:
            activation.groups = tuple(activation.firm_groups())
            for group in activation.groups:
                for slot in rule.slots:
                    group.taken[slot] = activation
        elif len(clause.needs) > 1 or len(rule.clauses) > 1:
            for spike in activation.firm_spikes():
                if spike.claims is None:
                    spike.claims = {}
                spike.claims[rule.index] = activation
        self.running[activation.id] = activation
        if rule.timeout is not None:
            activation.deadline = self.now + rule.timeout
            self._deadlines.add(activation.deadline, Kind.TIMEOUT, activation)
        for until in rule.until:
            self._watches.setdefault(until, {})[activation] = Watch(activation, until)
        payloads: dict[str, Any] = {}
        for need, spike in zip(clause.needs, activation.spikes, strict=True):
            payloads.setdefault(need.signal.name, spike.payload)  # type: ignore[union-attr]  # nothing is missing
        plans = self.policy.slot_plans
        values = {plans[slot].name: self.read(slot) for slot in rule.readable}
        if self.tracer is not None:
            ids = tuple(spike.id for spike in activation.spikes if spike is not None)
            self.tracer(trace.Started(self.now, activation.id, rule.name, clause.number, ids))
        self._out.append(Run(activation.id, rule.rule, payloads, values))

    def _settle_flags(self) -> bool:
        """Bring ``core:activity`` and ``core:pressure`` up to date (L22); whether one has changed."""
        pressure = bool(self.waiting)
        if pressure != self.read(self._pressure.index):
            self._change(self._pressure, pressure, (), None)
            return True
        activity = self._busy > 0
        if activity != self.read(self._activity.index):
            self._change(self._activity, activity, (), None)
            return True
        return False

    # ------------------------------------------------------------------------------------ outcomes

    def _consume(self, run: Activation, spikes: tuple[Spike, ...]) -> None:
        """Done: the slots are consumed in its groups, and everybody else gives up these spikes for them (L18)."""
        rule = run.clause.rule
        if rule.slots:
            for group in _roots(run):
                for slot in rule.slots:
                    group.taken[slot] = None
                for other in list(group.members):
                    if (
                        other is not run
                        and other.state < State.RUNNING
                        and not other.clause.rule.slotset.isdisjoint(rule.slotset)
                    ):
                        self._lose(other, self._of_group(other, group), "consumed")
                self._dirty[group] = None
        else:
            self._give_up(run, spikes, "consumed")

    def _relinquish(self, run: Activation, spikes: tuple[Spike, ...]) -> None:
        """Resigned, or failed before a write: the slots are free again, the rule gives up these spikes (L18)."""
        for group in _roots(run):
            for slot in run.clause.rule.slots:
                if group.taken.get(slot) is run:
                    del group.taken[slot]
            self._dirty[group] = None
        self._give_up(run, spikes, "resigned")

    def _give_up(self, run: Activation, spikes: tuple[Spike, ...], reason: str) -> None:
        """Every other activation of the rule gives up these spikes, and it never takes them again."""
        rule = run.clause.rule
        for spike in spikes:
            if spike.claims is not None and rule.index in spike.claims:
                spike.claims[rule.index] = None
            if len(spike.holders) > 1:
                for other in list(spike.holders):
                    if other is not run and other.clause.rule is rule and other.state < State.RUNNING:
                        self._lose(other, self._of_spike(other, spike), reason)
            if spike.refused is None:
                spike.refused = set()
            spike.refused.add(rule.index)

    def _retire(self, rule: RulePlan) -> None:
        self.retired.add(rule.index)
        for activation in list(self.active.get(rule.index, ())):
            if activation.state < State.RUNNING:
                for need in activation.clause.needs:
                    self._release(activation, need, "retired")
                self._end(activation)
        self._stirred = True

    def _fail(self, rule: RulePlan, exception: BaseException, *, signal: bool) -> None:
        self._out.append(Failed(rule.name, exception))
        if signal:
            error = self.policy.signal_of["core:error"]
            self._birth(error, RuleFailure(rule.name, exception), (), self._new_group(), None)

    def _cancel(self, run: Activation, reason: CancelReason) -> None:
        run.step(Step.CANCEL)
        run.told = reason
        run.deadline = NEVER
        if self.tracer is not None:
            self.tracer(trace.Told(self.now, run.id, run.clause.rule.name, reason))
        self._out.append(Cancel(run.id, reason))

    def _watch(self, spike: Spike) -> None:
        """Show a new spike to the `until` conditions of runs (L21)."""
        for need in spike.signal.watchers:
            for run, watch in list(self._watches.get(need.clause, {}).items()):
                if run.state == State.RUNNING and all(
                    self._test(p, spike.payload, run.clause.rule) for p in need.predicates
                ):
                    watch.spikes[need.index] = spike
                    self._judge(watch)

    def _judge(self, watch: Watch) -> None:
        due = watch.met_at(self.now)
        if due is None or watch.run.state != State.RUNNING:
            return
        if due > self.now:
            watch.due = due
            self._deadlines.add(due, Kind.WATCH, watch)
        elif all(self.holds(s, g, watch.clause.rule) for s, g in watch.clause.guards):
            self._cancel(watch.run, "interrupted")

    # ------------------------------------------------------------------------------------ deadlines

    def _stands(self, entry: Entry) -> bool:
        """Whether a deadline still counts."""
        time, kind, _, owner = entry
        if kind is Kind.EXPIRE:
            return owner.expires == time
        if kind is Kind.RIPEN:
            return owner.ripens == time
        if kind is Kind.PATIENCE:
            return owner.pressed == time
        if kind is Kind.STANDBY:
            group, clause, until = owner
            pressed = group.root().pressed
            return pressed is not None and pressed.get(clause) == until
        if kind is Kind.RECHECK:
            return owner.recheck == time
        if kind is Kind.TIMEOUT:
            return owner.deadline == time
        if kind is Kind.WATCH:
            return owner.due == time and owner.run.state == State.RUNNING
        return owner in self.live.get(owner.signal.index, ())

    def _due(self, entry: Entry) -> None:
        time, kind, _, owner = entry
        if kind is Kind.EXPIRE:
            owner.expires = NEVER
            needs = owner.clause.needs
            old = [n for n in needs if (s := owner.spikes[n.index]) is not None and s.born + n.max_age <= time]
            self._lose(owner, old, "age")
        elif kind is Kind.RIPEN:
            owner.ripens = NEVER
            self._update(owner)
        elif kind is Kind.PATIENCE:
            owner.pressed = NEVER
            self._dirty.update(dict.fromkeys(owner.firm_groups()))
            if self._pressed_for_nothing(owner):
                return
            for need in owner.clause.needs:
                spike = owner.spikes[need.index]
                if spike is not None and not need.detached:
                    if spike.refused is None:
                        spike.refused = set()
                    spike.refused.add(owner.clause.rule.index)
            for need in owner.clause.needs:
                self._release(owner, need, "eliminated")
            self._end(owner)
        elif kind is Kind.STANDBY:
            group, clause, _ = owner
            group = group.root()
            del group.pressed[clause]
            rival = self.policy.clause_plans[clause]
            if Horizon(self).viable(rival, None, group, rival.rule.slotset) != FIRM:
                if group.eliminated is None:
                    group.eliminated = set()
                group.eliminated.add(clause)
            self._dirty[group] = None
        elif kind is Kind.RECHECK:
            owner.recheck = NEVER
            if owner.state == State.WAITING:
                self._asking[owner] = None
        elif kind is Kind.TIMEOUT:
            self._cancel(owner, "timeout")
        elif kind is Kind.WATCH:
            owner.due = NEVER
            self._judge(owner)
        else:
            self._forget(owner)

    def _pressed_for_nothing(self, rival: Activation) -> bool:
        """Whether, when its patience ends, nobody waits for it any more, or it no longer depends on luck (L16)."""
        slots = rival.clause.rule.slotset
        groups = rival.firm_groups()
        waited = any(
            rival.clause.rule.name in waiter.waits_for and not waiter.clause.rule.slotset.isdisjoint(slots)
            for group in groups
            for waiter in group.members
            if waiter.state == State.WAITING
        )
        if not waited:
            return True
        return all(Horizon(self).viable(rival.clause, rival, group, slots) == FIRM for group in groups)


class _Absent:
    def __repr__(self) -> str:
        return "absent"


ABSENT: Any = _Absent()


def _age(activation: Activation) -> int:
    return activation.id


def _roots(run: Activation) -> list[Group]:
    """The groups of a run as they are now."""
    return list(dict.fromkeys(group.root() for group in run.groups))


def _overdue(rule: RulePlan) -> str:
    return f"rule {rule.name} took longer than its timeout of {rule.timeout:g} s ({rule.rule.origin})"


def _equal(old: Any, new: Any) -> bool:
    if old is new:
        return True
    try:
        return bool(old == new)
    except Exception:  # values that cannot be compared (arrays, say) are different
        return False


HANDLERS: dict[type, Any] = {
    events.Start: Engine._on_start,
    events.Stop: Engine._on_stop,
    events.Write: Engine._on_write,
    events.Store: Engine._on_store,
    events.Discard: Engine._on_discard,
    events.Emit: Engine._on_emit,
    events.Wipe: Engine._on_wipe,
    events.Finish: Engine._on_finish,
    events.AddRule: Engine._on_add_rule,
}
