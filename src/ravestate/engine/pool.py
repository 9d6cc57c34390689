"""The pool: live spikes, the activations that hold them, and their causal groups (L11, L12, L14, L20, L23).

Everything is indexed by what it concerns: live spikes by signal, activations by rule, and those that lack
something by the need that they lack. So an event costs by what it concerns, never by how many rules there are.
"""

from __future__ import annotations

import copy
from collections.abc import Iterable
from types import MappingProxyType
from typing import Any

from ravestate.declare.condition import Holds
from ravestate.declare.core import RuleFailure
from ravestate.engine import trace
from ravestate.engine.activation import NEVER, Activation, State, Step
from ravestate.engine.deadlines import Deadlines, Entry, Kind
from ravestate.engine.effects import Cancel, CancelReason, Effect, Failed, Spiked
from ravestate.engine.group import Group
from ravestate.engine.spike import Spike
from ravestate.engine.trace import Tracer
from ravestate.engine.watch import Watch
from ravestate.policy.plan import Clause, Need, RulePlan, SignalPlan, SlotPlan
from ravestate.policy.policy import Policy

__all__ = ["Pool"]

PASSIVE = (int, float, str, bytes, bool, type(None), MappingProxyType)
"""Types of which a context needs no copy of its own."""


class Pool:
    """Spikes are born, offered, held, given up and forgotten here; who may run is decided above."""

    def __init__(self, policy: Policy) -> None:
        self.policy = policy
        self.now = 0.0
        self.tracer: Tracer | None = None
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
        self.waiting: dict[Activation, None] = {}
        """Ready activations that were refused consent."""
        self.running: dict[int, Activation] = {}
        """Activations whose function runs, by the number of the run."""
        self.retired: set[int] = set()
        self.dropped: dict[str, int] = {}
        """How many spikes overflowed, by signal (L23)."""
        self.watched: dict[str, int] = {}
        """Signals whose spikes are reported."""
        self._out: list[Effect] = []
        self._free: list[Activation] = []  # ready, and in need of nobody's consent
        self._asking: dict[Activation, None] = {}  # ready, and to be asked for consent
        self._dirty: dict[Group, None] = {}  # groups in which something ended
        self._stirred = False  # something ended that those who wait on patience may have waited for
        self._watches: dict[Clause, dict[Activation, Watch]] = {}
        self._blamed: set[int] = set()  # predicates whose failure has been reported
        self._deadlines = Deadlines(self._stands)
        self._busy = 0  # activations of rules that are not in the background
        self._activations = 0  # numbers given so far
        self._spikes = 0
        self._groups = 0

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

    def read(self, slot: int) -> Any:
        """The value of a slot, by its number."""
        try:
            return self.values[slot]
        except KeyError:
            default: Any = self.policy.slot_plans[slot].slot.default
            if not isinstance(default, PASSIVE):
                default = copy.deepcopy(default)  # contexts share no state
            self.values[slot] = default
            return self.values[slot]

    def live_spike(self, need: Need) -> Spike | None:
        """A live spike, not given up by the rule and not consumed for it, that could meet a need."""
        return next(
            (spike for spike in self.live.get(need.signal.index, ()) if self._fits(need, spike)), None
        )

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

    def holds(self, slot: SlotPlan, guard: Holds, rule: RulePlan) -> bool:
        """Whether a predicate on a slot's present value is true; one that fails is false, and is reported."""
        return self._test(guard.predicate, self.read(slot.index), rule)

    def _test(self, predicate: Any, value: Any, rule: RulePlan) -> bool:
        try:
            return bool(predicate(value))
        except Exception as exception:  # a predicate is the designer's code: it may fail in any way
            if id(predicate) not in self._blamed:
                self._blamed.add(id(predicate))
                self._fail(rule, exception, signal=True)
            return False

    def _fail(self, rule: RulePlan, exception: BaseException, *, signal: bool) -> None:
        self._out.append(Failed(rule.name, exception))
        if signal:
            error = self.policy.signal_of["core:error"]
            self._birth(error, RuleFailure(rule.name, exception), (), self._new_group(), None)

    def _parents(self, run: Activation | None) -> tuple[Spike, ...]:
        return () if run is None or run.clause.rule.detached else run.stands_on

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
        if clause.simple:
            self._complete(activation)
            return
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
                    self.now,
                    activation.id,
                    clause.rule.name,
                    clause.number,
                    spike.id,
                    spike.signal.name,
                    lacks,
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
                    self._complete(activation)
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

    def _complete(self, activation: Activation) -> None:
        """It is ready: a writer asks for consent, others just start."""
        activation.expires = NEVER
        activation.pressed = NEVER
        activation.step(Step.COMPLETE)
        clause = activation.clause
        if clause.rule.slots and clause.firm_bits:
            self._asking[activation] = None
        else:
            self._free.append(activation)

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

    def _lose_interest(self, activation: Activation) -> None:
        """It waits no longer: what happens in those groups does not concern it."""
        self.waiting.pop(activation, None)
        for group in activation.interests:
            group.root().interested.pop(activation, None)
        activation.interests = ()

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


def _age(activation: Activation) -> int:
    return activation.id
