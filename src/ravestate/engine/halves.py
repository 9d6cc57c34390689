"""Halves: first spikes that wait, without an activation, for a second spike.

A clause with two constraints, its *needs*, takes two spikes. A *half* (`Half`) is a set of needs for the same signal,
all of which the engine can treat alike. Suppose that a thousand rules have conditions such as `input & chess`, each
with a topic of its own. They would need a thousand activations for each input, although few of the topics occur. So one
half holds the input's spike for all these rules. The spike is an *entry* in a table (``entries.py``), without
activations.

The engine makes activations when the second spike, the *counterpart*, arrives. If many first spikes wait for it, the
number of activations depends on the rule:

- for a rule that writes no slot: one activation, with the oldest first spike
- for a rule without a better rival (`Half.sole`): also one activation, but all first spikes share the counterpart
  (``benches.py``)
- for any other rule that writes a slot: one activation for each first spike, because consent chooses one of them
- for a rule that writes no slot, but was added while a spike of its signals was live: also one activation for each
  first spike, because each activation may later lose a spike, and take that live spike instead

To *unfold* an entry is to make its activations. All entries unfold if there is a tracer, in an endless loop, and when a
rule retires or is added. The entries of a group unfold before the group merges. `Consent` unfolds an entry if it must
judge the entry's clauses one by one. The time of unfolding changes no decision: the numbers of these activations are
fixed from the start, and no signal that their rules raise can help a rival (`find_halves`). An explanation unfolds
nothing.
"""

from __future__ import annotations

from collections import OrderedDict
from typing import Final

from ravestate.engine.activation import RUNNING, Activation, by_age
from ravestate.engine.conflict_sets import ConflictSets
from ravestate.engine.entries import Entries
from ravestate.engine.group import NOTHING, Group
from ravestate.engine.holdings import Holdings
from ravestate.engine.row import Row
from ravestate.engine.spike import Spike
from ravestate.engine.state import State
from ravestate.policy.model import Clause, Half, Need, SignalPlan
from ravestate.policy.policy import Policy

MANY: Final = 8
"""If a search meets more than this many spikes that do not fit, the half gets an index, a `Row`."""


class Halves:
    """The part of the engine that offers spikes to halves, and makes their activations."""

    __slots__ = ("entries", "holdings", "sets", "state")

    def __init__(self, state: State, entries: Entries, holdings: Holdings, sets: ConflictSets) -> None:
        self.state = state
        self.entries = entries
        self.holdings = holdings
        self.sets = sets

    def offer(self, signal: SignalPlan, spike: Spike) -> list[Need]:
        """Offer a new spike to the halves of its signal. Return the needs to which the caller must still offer the
        spike."""
        state = self.state
        group = spike.group.root()
        if group.interested:
            state.dirty[group] = None
        if state.tracer is not None or state.loops.full:
            self.unfold_all()
            return [need for half in signal.halves for need in half.needs]
        for half in signal.halves:
            if state.retired and state.retired.issuperset(half.places):
                continue
            first = half.needs[0]  # a need with a predicate is the only need of its half
            if group.finished(first.clause.rule.slots):
                continue
            if first.predicates and not state.accepts(first, spike.payload):
                continue
            apart: set[int] = set()  # the clauses for which the half does not hold the spike
            for need in half.needs:
                if state.retired and need.clause.rule.index in state.retired:
                    apart.add(need.clause.index)
                    continue
                if need in state.lacking:
                    self.holdings.offer_to_lacking(need, spike)
                if state.halves and (group.entries or not half.kin) and self._pair(need, spike, group):
                    apart.add(need.clause.index)
            before = state.activations
            state.activations += len(half.needs)
            if len(apart) < len(half.needs):
                if apart:
                    spike.parted = apart | (spike.parted or set())
                self.entries.enter(spike, half, before)
                if state.hoping:
                    self.holdings.waits.stir_half(half)
                self._inherit_pressure(spike, half, group)
        return []

    def unfold_all(self) -> None:
        """Create the activations of all entries, and those of all alternatives: clauses that have no activation as long
        as a better clause of their conflict set has one (``conflict_sets.py``)."""
        self.sets.unfold_all()
        for half, spikes in list(self.state.halves.items()):
            for spike in list(spikes):
                self.unfold(spike, half)
        for half, seats in list(self.state.seats.items()):
            for spike in list(seats):
                self.unfold(spike, half)

    def unfold(self, spike: Spike, half: Half) -> None:
        """Create the activations of the clauses for which a half holds a spike."""
        for need in half.needs:
            if self.state.keeps(need, spike):
                self._make(need, spike)

    def unfold_clause(self, clause: Clause) -> None:
        """Create the activations of a clause for the spikes that its halves hold."""
        state = self.state
        for need in clause.needs if state.halves else ():
            for spike in list(state.halves.get(need.half, ())) if need.half is not None else ():
                if state.keeps(need, spike):
                    self._make(need, spike)

    def share(self, policy: Policy) -> None:
        """Create the activations that `_pair` left out, for clauses whose needs are kin only under a new policy.

        Kin needs may only hold spikes of one causal group.

        Under the old policy, an activation that lost a spike took the oldest live spike, and so formed the missing
        pairs. Under the new policy, such an activation may only take a spike of the same causal group (law L12). So
        each spike gets an activation, with the first counterpart that came after the spike.
        """
        for activations in list(self.state.active.values()):
            clause = next(iter(activations)).clause
            need, later = clause.needs[0], policy.clause_plans[clause.index].needs[0]
            if need.half is not None and not clause.rule.slots and later.kin != need.kin:
                self._share(clause, [one for one in activations if one.state < RUNNING])

    def _share(self, clause: Clause, activations: list[Activation]) -> None:
        """Create the left-out activations of a clause; `activations` has all its activations that do not run yet."""
        state, holdings = self.state, self.holdings
        own: dict[Spike, Activation] = {}  # spike → the activation that began with it
        held: set[Spike] = set()
        for activation in sorted(activations, key=by_age):
            spikes = [spike for spike in activation.spikes if spike is not None]
            held.update(spikes)
            older = [spike for spike in spikes if spike.before < activation.id]
            if older:
                own.setdefault(max(older, key=_birth), activation)
        if len(own) == len(held):
            return  # no activation was left out
        taken = {activation.id for each in state.active.values() for activation in each}
        for spike in sorted(held.difference(own), key=_birth):
            number = spike.before + 1  # `offer` reserved a number for this activation
            while number in taken:
                number += 1
            taken.add(number)
            activation = own[spike] = holdings.new_activation(clause, number)
            need = _need(clause, spike)
            holdings.acquire(activation, need, spike)
            state.lacking.setdefault(clause.needs[1 - need.index], {})[activation] = None
        later: dict[Need, Spike] = {}
        for spike in sorted(held, key=_birth, reverse=True):
            need = _need(clause, spike)
            later[need] = spike
            other = clause.needs[1 - need.index]
            activation = own[spike]
            if other in later and activation.spike(other) is not later[other]:
                if activation.missing:
                    holdings.acquire(activation, other, later[other])
                    holdings.update(activation)
                else:
                    holdings.unready(activation)
                    holdings.swap(activation, other, later[other])
                holdings.waits.stir(activation)

    def unfold_group(self, group: Group) -> None:
        """Create the activations of all entries of a group."""
        for spike in list(group.entries):
            for half in self.state.halves_of(spike):
                self.unfold(spike, half)

    def take_over(self, activation: Activation, group: Group) -> None:
        """Put a new activation under pressure in a group, if its clause was under pressure there before it had a spike
        (L16)."""
        until = (group.patience_ends or {}).get(activation.clause.index)
        if until is not None:
            self.holdings.put_under_pressure(activation, group, until)

    def _make(self, need: Need, spike: Spike) -> Activation:
        """Create the activation of a clause for which a half holds a spike."""
        bench = self.state.bench_of(need.half, spike) if need.half is not None else None
        if bench is not None and bench.partner is not None:
            return self.holdings.benches.make(bench, spike)
        clause = need.clause
        activation = self.holdings.new_activation(clause, self.state.entry_number(need, spike))
        self.holdings.acquire(activation, need, spike)
        until = self.state.entry_patience(need, spike)
        if until is not None:
            self.holdings.put_under_pressure(activation, spike.group.root(), until)
        self.entries.part(spike, need)
        self.state.lacking.setdefault(clause.needs[1 - need.index], {})[activation] = None
        return activation

    def _pair(self, need: Need, spike: Spike, group: Group) -> bool:
        """Make the activations whose second spike is a new spike. Return whether the clause needs no entry for this
        spike.

        If a clause's rule writes no slot, and a first spike waits, the clause needs no entry. The activation with the
        oldest first spike then takes the new spike.
        """
        state = self.state
        partner = need.clause.needs[1 - need.index]
        waiting = state.halves.get(partner.half) if partner.half is not None else None
        if not waiting:
            return False
        if len(waiting) > 1 and partner.half is not None and partner.half.sole:
            self.holdings.benches.seat(partner.half, spike)
            return False
        one = not need.clause.rule.slots and not (state.added and self._has_elder(need.clause))
        if need.kin != need.bit:
            found: list[Spike] = sorted((s for s in group.entries if state.keeps(partner, s)), key=waiting.__getitem__)
        else:
            found = self._find(partner, waiting, one=one)
        for first in found[:1] if one else found:
            activation = self._make(partner, first)
            self.holdings.acquire(activation, need, spike)
            self.holdings.waits.stir(activation)
            self.holdings.update(activation)
        return one and bool(found)

    def _has_elder(self, clause: Clause) -> bool:
        """Return whether a live spike that fits a clause may have been born before the clause's rule was added.

        No half holds such a spike, but an activation that loses another spike may take it (L12).
        """
        state = self.state
        for need in clause.needs:
            for spike in state.live.get(need.signal.index, ()):
                if spike.id > state.added:
                    break
                if state.fits(need, spike):
                    return True
        return False

    def _find(self, need: Need, waiting: OrderedDict[Spike, int], *, one: bool) -> list[Spike]:
        """Return the spikes that the need's half holds for the need, oldest first; with `one`, only the oldest."""
        state, half, found, passed = self.state, need.half, list[Spike](), 0
        assert half is not None
        row = state.rows.get(half)
        if row is not None:
            return row.find(need, state, all_=not one)
        for first in waiting:
            if state.keeps(need, first):
                found.append(first)
                if one:
                    break
            else:
                passed += 1
        if passed > MANY:
            if state.rows is NOTHING:
                state.rows = {}
            state.rows[half] = Row(waiting)
        return found

    def _inherit_pressure(self, spike: Spike, half: Half, group: Group) -> None:
        """If a clause was under pressure in the group before it had a spike, create an activation of the clause under
        this pressure."""
        for number in group.patience_ends or ():
            clause = self.state.policy.clause_plans[number]
            place = half.places.get(clause.rule.index)
            if place is not None and self.state.keeps(half.needs[place], spike):
                self.take_over(self._make(half.needs[place], spike), group)


def _birth(spike: Spike) -> int:
    return spike.id


def _need(clause: Clause, spike: Spike) -> Need:
    """Return the one of a clause's two needs that a spike meets."""
    return clause.needs[0] if clause.needs[0].signal is spike.signal else clause.needs[1]
