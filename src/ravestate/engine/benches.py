"""Benches: spikes that wait together for a second spike, their *counterpart*.

A clause with two constraints, its *needs*, takes a pair of spikes. The spike that arrives first is the *first spike*.
It waits in a *half*: a table of such first spikes, without activations (``halves.py``). A *bench* is a part of a
half: the first spikes that have no counterpart yet, or those that share one.

Suppose that a hundred first spikes wait when a counterpart arrives. The counterpart completes a hundred pairs. Only one
pair runs, and the first spikes of the other pairs take the next counterpart (L12). So only the oldest pair gets an
activation, the *head* of the bench. The other first spikes stay on the bench, without activations. The
whole bench takes the next counterpart.

A clause has benches only if no better clause competes with it (`Half.sole`). The clause's activations wait for no
rival, so a group refuses them only while one of their slots is taken there. If only the first spike's group refuses the
head, the engine creates a new head for the next first spike. The new head asks in the same round
(`Agenda.consent_round`). If the counterpart's group refuses, it would refuse every head.

So the pairs ask in the order of their first spikes, the oldest first. In consent, older causal groups go first. The two
orders agree: a first spike comes from outside or from a detached rule, and so begins a group. Before a group merges,
its spikes leave their benches.

`Consent` treats each spike on a bench with a counterpart like a ready activation: activations of clauses with less
utility wait for it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from ravestate.engine.activation import GATHERING, RUNNING, WAITING, Activation
from ravestate.engine.bench import Bench
from ravestate.engine.group import NOTHING
from ravestate.engine.spike import Spike
from ravestate.policy.model import Half, Need

if TYPE_CHECKING:
    from ravestate.engine.holdings import Holdings


class Benches:
    """The part of the engine that gives each bench a counterpart, and creates the benches' heads."""

    __slots__ = ("holdings", "state")

    def __init__(self, holdings: Holdings) -> None:
        self.holdings = holdings
        self.state = holdings.state

    def seat(self, half: Half, partner: Spike) -> None:
        """Give a new counterpart to all first spikes that wait in a half without a counterpart."""
        del self.state.halves[half]
        self._place(self.state.pools.pop(half), partner)

    def check(self, partner: Spike) -> None:
        """Look again at each bench whose counterpart is `partner`.

        If a bench can no longer use this counterpart, give the bench another one. Otherwise, create the bench's head,
        unless another activation of its clause runs with the counterpart, or will ask before the head.
        """
        state = self.state
        for bench in list(state.benches.get(partner, {}).values()):
            rule = bench.half.needs[0].clause.rule
            lost = partner.refused is not None and rule.index in partner.refused
            if lost or not state.is_live(partner) or partner.group.root().finished(rule.slots):
                self._move(bench)
            else:
                self._lead(bench, partner)

    def unbench(self, spike: Spike) -> None:
        """Create an activation for each pair of `spike` and a counterpart, before these pairs lose one of their spikes.

        An activation that loses a spike may take another one instead (L12). A pair on a bench cannot.
        """
        state = self.state
        for half in state.halves_of(spike) if state.benches else ():
            bench = state.bench_of(half, spike)
            if bench is not None and bench.partner is not None:
                self.make(bench, spike)

    def settle(self) -> None:
        """Create new heads for the benches whose heads have gone."""
        state = self.state
        while state.headless:
            partner, _ = state.headless.popitem()
            self.check(partner)

    def next_heads(self, refused: Activation) -> list[Activation]:
        """Create a new head for each bench whose head, `refused`, got no consent. Return the new heads that may ask.

        If the counterpart's group refuses, a bench gets no new head.
        """
        state = self.state
        heads: list[Activation] = []
        for partner in refused.spikes:
            benches = [*state.benches.get(partner, {}).values()] if partner is not None else []
            asked = [b for b in benches if b.half.needs[0].clause is refused.clause and not _is_taken(b)]
            heads += [self.make(bench, next(iter(bench.spikes))) for bench in asked]
        return [head for head in heads if head in state.asking]

    def make(self, bench: Bench, spike: Spike) -> Activation:
        """Create the activation of a spike on a bench with a counterpart."""
        holdings, need, partner = self.holdings, bench.half.needs[0], bench.partner
        assert partner is not None
        activation = holdings.new_activation(need.clause, self.state.entry_number(need, spike))
        until = self.state.entry_patience(need, spike)
        if until is not None:
            holdings.put_under_pressure(activation, spike.group.root(), until)
        holdings.acquire(activation, need, spike)
        holdings.acquire(activation, other_need(need), partner)
        holdings.entries.part(spike, need)
        holdings.waits.stir(activation)
        holdings.update(activation)
        return activation

    def _place(self, bench: Bench, partner: Spike) -> None:
        state = self.state
        if state.benches is NOTHING:
            state.benches = {}
        found = state.benches.setdefault(partner, {})
        other = found.get(bench.half)
        if other is None:
            bench.partner = partner
            found[bench.half] = bench
            partner.in_halves += 1
            partner.group.root().enter(partner)
        else:
            bench = self._join(other, bench)
            bench.partner = partner
            found[bench.half] = bench
        self._lead(bench, partner)

    def _move(self, bench: Bench) -> None:
        """Give a bench the oldest live counterpart that fits (L12). If none fits, the bench waits for the next
        counterpart."""
        state, half = self.state, bench.half
        self.holdings.entries.vacate(bench)
        need = other_need(half.needs[0])
        for spike in state.live.get(need.signal.index, ()):
            if state.fits(need, spike):
                self._place(bench, spike)
                return
        pool = state.pools.get(half)
        if pool is not None:
            bench = self._join(pool, bench)
            bench.partner = None
        state.pools[half] = bench
        state.halves[half] = bench.spikes
        for spike in bench.spikes:
            group = spike.group.root()
            if group.interested:
                state.dirty[group] = None  # the spike was a ready rival, and may be under pressure now
        late, bench.late = bench.late, []
        for spike in late:
            if spike in bench.spikes:
                self.holdings.entries.let_expire(spike, spike.born + half.max_age)

    def _join(self, one: Bench, other: Bench) -> Bench:
        """Join two benches into one: the longer bench takes over the spikes of the other."""
        longer, shorter = (one, other) if len(one.spikes) >= len(other.spikes) else (other, one)
        seats = self.state.seats[one.half]
        for spike in shorter.spikes:
            seats[spike] = longer
        longer.join(shorter)
        return longer

    def _lead(self, bench: Bench, partner: Spike) -> None:
        """Create a bench's head, unless another activation of its clause runs with the counterpart or will ask
        first."""
        need = bench.half.needs[0]
        first = next(iter(bench.spikes))
        cause = min(first.group.root().id, partner.group.root().id)
        order = (cause, self.state.entry_number(need, first))
        taken = _is_taken(bench)
        for holder in partner.holders:
            if holder.clause is not need.clause or holder.state == GATHERING:
                continue
            if holder.state >= RUNNING:
                return
            if holder.state == WAITING and not taken and holder not in self.state.asking:
                continue  # a group refuses this activation, but not the counterpart's group
            if (min([group.id for group in holder.firm_groups()]), holder.id) <= order:
                return
        self.make(bench, first)


def other_need(need: Need) -> Need:
    """Return the other need of a clause that has two needs."""
    return need.clause.needs[1 - need.index]


def _is_taken(bench: Bench) -> bool:
    """Return whether a slot of the bench's rule is taken in the group of the bench's counterpart."""
    assert bench.partner is not None
    return not bench.partner.group.root().taken.keys().isdisjoint(bench.half.slotset)
