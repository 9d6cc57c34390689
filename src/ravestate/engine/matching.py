"""Matching: spikes are born into causal groups and offered to the activations that lack them (L11, L12, L21)."""

from __future__ import annotations

from typing import Any

from ravestate.engine import trace
from ravestate.engine.activation import CANCEL, GATHERING, NEVER, RUNNING, Activation
from ravestate.engine.deadlines import LOOK, WATCH
from ravestate.engine.effects import Cancel, CancelReason, Spiked
from ravestate.engine.group import Group
from ravestate.engine.halves import Halves
from ravestate.engine.horizon import SEEN
from ravestate.engine.loops import MANY, Lineage
from ravestate.engine.spike import Spike
from ravestate.engine.watch import Watch
from ravestate.policy.model import Need, SignalPlan


class Matching(Halves):
    """The layer of the engine that creates spikes, groups them, and offers them to activations."""

    __slots__ = ()

    def _parents(self, run: Activation | None) -> tuple[Spike, ...]:
        """Return the parents of the spikes that a run raises; none for a detached rule, or for code outside (L19)."""
        return () if run is None or run.clause.rule.detached else run.stands_on

    def _origin(self, run: Activation | None) -> tuple[tuple[Spike, ...], Group]:
        """Return the parents and the causal group of the spikes that a run raises."""
        parents = self._parents(run)
        return parents, self._group_of(parents)

    def _new_group(self) -> Group:
        self._groups += 1
        return Group(self._groups)

    def _group_of(self, parents: tuple[Spike, ...]) -> Group:
        """Merge the causal groups of the parents, and return the merged group (L11); without parents, a new group."""
        if not parents:
            return self._new_group()
        root = parents[0].group.root()
        for parent in parents[1:]:
            other = parent.group.root()
            if other is not root:
                root = self._merge(root, other)
        return root

    def _merge(self, one: Group, other: Group) -> Group:
        """Merge two causal groups into the older one, and return it."""
        root, merged = (one, other) if one.id < other.id else (other, one)
        self._unfold_group(one)
        self._unfold_group(other)
        root.absorb(merged)
        if self.tracer is not None:
            self.tracer(trace.Merged(self.now, merged.id, root.id))
        done = {slot for slot, holders in root.taken.items() if holders is None}
        for activation in list(root.members):
            if activation.state < RUNNING and not activation.clause.rule.slotset.isdisjoint(done):
                self._lose(activation, self._of_group(activation, root), "consumed")
        self._offer_again(root)
        self._dirty.pop(merged, None)
        self._dirty[root] = None
        return root

    def _offer_again(self, group: Group) -> None:
        """Offer the spikes of a merged group again, oldest first: coherence kept some of them apart until now (L12).

        As at its birth, a spike is offered only to activations that are older than the spike, oldest first.
        """
        offers: list[tuple[int, int, int, Activation, Spike]] = []
        for activation in group.members:
            if activation.state is not GATHERING or not activation.missing:
                continue
            for need in activation.clause.needs:
                if need.bit & activation.missing and need.kin != need.bit and not need.detached:
                    offers += [
                        (spike.id, activation.id, need.index, activation, spike)
                        for spike in self.live.get(need.signal.index, ())
                        if activation.id <= spike.before and spike.group.root() is group
                    ]
        for _, _, index, activation, spike in sorted(offers, key=_birth_order):
            need = activation.clause.needs[index]
            if activation.state is not GATHERING or not need.bit & activation.missing:
                continue  # an earlier offer has met the need
            if self._coherent(activation, need, spike) and self._fits(need, spike):
                self._acquire(activation, need, spike)
                self._stir(activation)
                self._update(activation)

    def _birth(
        self,
        signal: SignalPlan,
        payload: Any,
        parents: tuple[Spike, ...],
        group: Group,
        run: Activation | None,
        lineage: Lineage | None = None,
    ) -> None:
        """Create a spike, and offer it to the activations that lack it (L11, L12)."""
        self._spikes += 1
        source = 0 if run is None else run.id
        if run is not None and run.told == "wiped" and parents:
            return  # the run started with a wiped spike, so this spike is wiped too (L20)
        if self.tracer is not None:
            ids = tuple(parent.id for parent in parents)
            self.tracer(trace.Born(self.now, self._spikes, signal.name, group.id, ids, source, payload))
        if self.watched and signal.name in self.watched:
            self._out.append(Spiked(signal.name, payload))
        if not signal.listeners and not (signal.watchers and self._watches):
            return
        rule = -1 if run is None or run.clause.rule.detached else run.clause.rule.index
        spike = Spike(self._spikes, signal, payload, self.now, group, parents, source, rule, self._activations)
        if self._loops.runs > MANY:
            spike.lineage = lineage if run is None else self._loops.lineage(run)
        live = self.live.get(signal.index)
        if live is None:
            live = self.live[signal.index] = {}
        live[spike] = None
        if len(live) > signal.limit:
            self.dropped[signal.name] = self.dropped.get(signal.name, 0) + 1
            self._kill(next(iter(live)), "overflow")
        if signal.watchers and self._watches:
            self._watch(spike)
        if self.hoping and (SEEN, signal.index) in self.hoping:
            self._stirred[SEEN, signal.index] = None
        for need in signal.others:
            self._offer(need, spike)
        if signal.halves:
            for need in self._offer_to_halves(signal, spike):
                self._offer(need, spike)
        if signal.contests:
            self._offer_to_sets(signal, spike)
        if not (spike.holders or spike.entries):
            self._forget(spike)

    def _offer(self, need: Need, spike: Spike) -> None:
        """Offer a new spike to every activation that lacks it, oldest first, then to the clause's stand-by."""
        clause = need.clause
        rule = clause.rule
        if self.retired and rule.index in self.retired:
            return
        for predicate in need.predicates:
            if not self._test(predicate, spike.payload, rule):
                self._pass_by(clause, spike, "payload")
                return
        if not need.detached:
            if clause.cyclic and spike.descends_from(rule.index):
                self._pass_by(clause, spike, "caused")
                return
            if spike.group.taken and spike.group.finished(rule.slots):
                self._pass_by(clause, spike, "consumed")
                return
        if need in self.lacking:
            self._offer_to_lacking(need, spike)
        if need.detached and clause.asks_detached:
            if need.min_age:
                self._deadlines.add(spike.born + need.min_age, LOOK, (need, spike))
            else:
                self._show(need, spike)
            return  # a detached need only looks: it starts no activation
        self._activations += 1
        activation = self._new_activation(clause, self._activations)
        self._acquire(activation, need, spike)
        if not need.detached:
            group = spike.group.root()
            if group.interested:
                self._dirty[group] = None
            if group.pressed:
                self._take_over(activation, group)
        if clause.simple:
            self._complete(activation)
            return
        if clause.asks_detached:
            self._look(activation, clause.needs)
        if activation.missing:
            for other in clause.needs:
                if other.bit & activation.missing:
                    self.lacking.setdefault(other, {})[activation] = None
        self._update(activation)

    def _show(self, need: Need, spike: Spike) -> None:
        """Give a new spike to the activations that look at its signal already, for they hold the newest (L19)."""
        for activation in list(self.active.get(need.clause.rule.index, ())):
            if activation.clause is need.clause and activation.state < RUNNING and not activation.missing & need.bit:
                held = activation.spikes[need.index]
                if held is not None and held.id < spike.id:
                    self._swap(activation, need, spike)

    def on_look(self, time: float, looking: tuple[Need, Spike]) -> None:
        """Show a spike to a detached need for which it is old enough now (L19)."""
        need, spike = looking
        need = self.policy.clause_plans[need.clause.index].needs[need.index]  # a rule may have been added since
        if self._fits(need, spike):
            self._show(need, spike)

    def on_watch(self, time: float, watch: Watch) -> None:
        """Judge an `until` condition whose spikes are old enough now (L21)."""
        watch.due = NEVER
        self._judge(watch)

    def _watch(self, spike: Spike) -> None:
        """Offer a new spike to the `until` conditions of runs (L21)."""
        for need in spike.signal.watchers:
            for run, watch in list(self._watches.get(need.clause, {}).items()):
                if run.state == RUNNING and all(self._test(p, spike.payload, run.clause.rule) for p in need.predicates):
                    held = watch.spikes[need.index]
                    if held is None or not need.min_age or held.born + need.max_age < self.now:
                        watch.spikes[need.index] = spike  # else the older spike ripens first
                        self._watched_by.setdefault(spike, {})[watch] = None
                        if held is not None and held not in watch.spikes:
                            self._unwatch(watch, held)
                    self._judge(watch)

    def _unwatch(self, watch: Watch, spike: Spike) -> None:
        """Note that a watch no longer keeps a spike."""
        watches = self._watched_by.get(spike, {})
        watches.pop(watch, None)
        if not watches:
            self._watched_by.pop(spike, None)

    def _judge(self, watch: Watch) -> None:
        """Interrupt the run of a watch whose condition is met, or set the time at which it will be met (L21)."""
        due = watch.met_at(self.now)
        if due is None or watch.run.state != RUNNING:
            return
        if due > self.now:
            watch.due = due
            self._deadlines.add(due, WATCH, watch)
        elif all(self.holds(s, g, watch.clause.rule) for s, g in watch.clause.guards):
            self._cancel(watch.run, "interrupted")

    def _cancel(self, run: Activation, reason: CancelReason) -> None:
        """Cancel a run, and order the runtime to stop its function."""
        run.step(CANCEL)
        run.told = reason
        run.deadline = NEVER
        if self.tracer is not None:
            self.tracer(trace.Told(self.now, run.id, run.clause.rule.name, reason))
        self._acts = True
        self._out.append(Cancel(run.id, reason))


def _birth_order(offer: tuple[int, int, int, Activation, Spike]) -> tuple[int, int, int]:
    return offer[:3]
