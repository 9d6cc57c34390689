"""Matching: each new spike joins a causal group, and is offered to the activations that lack it (laws L11, L12, L19).

A *need* is one constraint of a clause: one spike meets it. A detached need looks at a spike without consuming it.
"""

from __future__ import annotations

from typing import Any

from ravestate.engine import trace
from ravestate.engine.activation import GATHERING, RUNNING, SEEN, Activation
from ravestate.engine.conflict_sets import ConflictSets
from ravestate.engine.deadlines import LOOK
from ravestate.engine.effects import Spiked
from ravestate.engine.entries import Entries
from ravestate.engine.group import NOTHING, Group
from ravestate.engine.halves import Halves
from ravestate.engine.holdings import Holdings
from ravestate.engine.lineage import Lineage
from ravestate.engine.loops import MANY
from ravestate.engine.runs import Runs
from ravestate.engine.spike import Spike
from ravestate.engine.state import State
from ravestate.policy.model import Need, SignalPlan


class Matching:
    """The part of the engine that creates spikes, groups them, and offers them to activations."""

    __slots__ = ("entries", "halves", "holdings", "runs", "sets", "state")

    def __init__(
        self, state: State, entries: Entries, holdings: Holdings, sets: ConflictSets, halves: Halves, runs: Runs
    ) -> None:
        self.state = state
        self.entries = entries
        self.holdings = holdings
        self.sets = sets
        self.halves = halves
        self.runs = runs

    # ------------------------------------------------------------------------------------ groups

    def parents(self, run: Activation | None) -> tuple[Spike, ...]:
        """Return the parents of the spikes that a run raises; none for a detached rule or code outside the rules
        (L19)."""
        return () if run is None or run.clause.rule.detached else run.stands_on

    def new_group(self) -> Group:
        """Return a new causal group."""
        self.state.groups += 1
        return Group(self.state.groups)

    def group_of(self, parents: tuple[Spike, ...]) -> Group:
        """Merge the causal groups of the parents, and return the merged group (L11); without parents, a new group."""
        if not parents:
            return self.new_group()
        root = parents[0].group.root()
        if len(parents) > 1:
            for parent in parents:
                other = parent.group.root()
                if other is not root:
                    root = self._merge(root, other)
        return root

    def _merge(self, one: Group, other: Group) -> Group:
        """Merge two causal groups into the older one, and return it."""
        state = self.state
        root, merged = (one, other) if one.id < other.id else (other, one)
        self.halves.unfold_group(one)
        self.halves.unfold_group(other)
        root.absorb(merged)
        if state.tracer is not None:
            state.tracer(trace.Merged(state.now, merged.id, root.id))
        done = {slot for slot, holders in root.taken.items() if holders is None}
        for activation in root.members:
            if activation.state < RUNNING and not activation.clause.rule.slotset.isdisjoint(done):
                self.holdings.lose_group(activation, root, "consumed")
        for spike in list(root.entries):
            self.holdings.benches.check(spike)
        self._offer_again(root)
        state.dirty.pop(merged, None)
        state.dirty[root] = None
        state.reordered = True
        return root

    def _offer_again(self, group: Group) -> None:
        """Offer the spikes of a merged group again, oldest first.

        Some needs of a clause may only hold spikes of one group (L12). Before the merge, this limit kept some spikes of
        the two groups apart. As at its birth, a spike is offered only to activations that are older than the spike,
        oldest first.
        """
        state, holdings = self.state, self.holdings
        offers: list[tuple[int, int, int, Activation, Spike]] = []
        for activation in group.members:
            if activation.state != GATHERING or not activation.missing:
                continue
            for need in activation.clause.needs:
                if need.bit & activation.missing and need.kin != need.bit and not need.detached:
                    offers += [
                        (spike.id, activation.id, need.index, activation, spike)
                        for spike in state.live.get(need.signal.index, ())
                        if activation.id <= spike.before and spike.group.root() is group
                    ]
        for _, _, index, activation, spike in sorted(offers, key=_birth_order):
            need = activation.clause.needs[index]
            if activation.state != GATHERING or not need.bit & activation.missing:
                continue  # an earlier offer has met the need
            if holdings.is_coherent(activation, need, spike) and state.fits(need, spike):
                holdings.acquire(activation, need, spike)
                holdings.waits.stir(activation)
                holdings.update(activation)

    # ------------------------------------------------------------------------------------ births

    def emit(self, signal: SignalPlan, payload: Any, run: Activation | None, origin: Any = None) -> None:
        """Raise a signal, for a run or for code outside the rules (L11)."""
        if signal.keep_latest:
            self.holdings.withdraw(signal, "superseded")
        parents = self.parents(run)
        self.birth(signal, payload, parents, self.group_of(parents), run, origin)

    def birth(
        self,
        signal: SignalPlan,
        payload: Any,
        parents: tuple[Spike, ...],
        group: Group,
        run: Activation | None,
        origin: Any = None,
        lineage: Lineage | None = None,
    ) -> None:
        """Create a spike, and offer it to the activations that lack it (L11, L12).

        If no rule can hear the signal, only the trace and the runtime learn of the spike.
        """
        state = self.state
        state.spikes += 1
        if run is not None and run.told == "wiped" and parents:
            return  # the run started with a wiped spike, so this spike is wiped too (L20)
        if state.tracer is not None:
            ids = tuple([parent.id for parent in parents])
            source = 0 if run is None else run.id
            state.tracer(trace.Born(state.now, state.spikes, signal.name, group.id, ids, source, payload))
        if state.watched and signal.name in state.watched:
            state.out.append(Spiked(signal.name, payload))
        if not signal.listeners and not (signal.watchers and state.watches):
            return
        rule = -1 if run is None or run.clause.rule.detached else run.clause.rule.index
        spike = Spike(state.spikes, signal, payload, state.now, group, parents, rule, state.activations)
        spike.origin = origin if run is None else run.origin
        if state.loops.runs > MANY:
            spike.lineage = lineage if run is None else state.loops.lineage(run)
        live = state.live.get(signal.index)
        if live is None:
            live = state.live[signal.index] = {}
        live[spike] = None
        if len(live) > signal.limit:
            if state.dropped is NOTHING:
                state.dropped = {}
            state.dropped[signal.name] = state.dropped.get(signal.name, 0) + 1
            self.holdings.kill(next(iter(live)), "overflow")
        if signal.watchers and state.watches:
            self.runs.watch(spike)
        if state.hoping and (SEEN, signal.index) in state.hoping:
            state.stirred[SEEN, signal.index] = None
        for need in signal.others:
            self._offer(need, spike)
        if signal.halves:
            for need in self.halves.offer(signal, spike):
                self._offer(need, spike)
        if signal.conflict_sets:
            self.sets.offer(signal, spike)
        if spike.holder is None and not (spike.is_held or spike.in_halves):
            self.entries.forget(spike)

    def _offer(self, need: Need, spike: Spike) -> None:
        """Offer a new spike to every activation that lacks it, oldest first. Then create a new activation with the
        spike (L12)."""
        state, holdings = self.state, self.holdings
        clause = need.clause
        rule = clause.rule
        if state.retired and rule.index in state.retired:
            return
        if not need.detached:
            if clause.cyclic and spike.descends_from(rule.index):
                holdings.pass_by(clause, spike, "caused")
                return
            if spike.group.taken and spike.group.finished(rule.slots):
                holdings.pass_by(clause, spike, "consumed")
                return
        if need.predicates and not state.accepts(need, spike.payload):
            holdings.pass_by(clause, spike, "payload")
            return
        if need in state.lacking:
            holdings.offer_to_lacking(need, spike)
        if need.detached and clause.asks_detached:
            if need.min_age:
                state.deadlines.add(spike.born + need.min_age, LOOK, (need, spike))
            else:
                self._show(need, spike)
            return  # a detached need only looks: it starts no activation
        state.activations += 1
        activation = holdings.new_activation(clause, state.activations)
        holdings.acquire(activation, need, spike)
        if not need.detached:
            group = spike.group.root()
            if group.interested:
                state.dirty[group] = None
            if group.patience_ends:
                self.halves.take_over(activation, group)
        if clause.simple:
            holdings.complete(activation)
            return
        if clause.asks_detached:
            holdings.look(activation, clause.needs)
        if activation.missing:
            for other in clause.needs:
                if other.bit & activation.missing:
                    state.lacking.setdefault(other, {})[activation] = None
        holdings.update(activation)

    def _show(self, need: Need, spike: Spike) -> None:
        """Give a spike to the activations of a detached need's clause, in place of the older spike that they look at
        (L19)."""
        for activation in list(self.state.active.get(need.clause.rule.index, ())):
            if activation.clause is need.clause and activation.state < RUNNING and not activation.missing & need.bit:
                held = activation.spike(need)
                if held is not None and held.id < spike.id:
                    self.holdings.swap(activation, need, spike)

    def on_look(self, looking: tuple[Need, Spike]) -> None:
        """Show a spike to a detached need for which it is old enough now (L19)."""
        need, spike = looking
        need = self.state.policy.clause_plans[need.clause.index].needs[need.index]  # a new rule replaces all records
        if self.state.fits(need, spike):
            self._show(need, spike)


def _birth_order(offer: tuple[int, int, int, Activation, Spike]) -> tuple[int, int, int]:
    return offer[:3]
