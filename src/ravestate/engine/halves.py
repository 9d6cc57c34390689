"""Halves: spikes that meet the first need of a clause of two needs.

A thousand rules `input & topic` would need a thousand activations for each input, although only a few of the topics
occur. And of a hundred spikes that wait for their counterpart, a new one may have any, but only the oldest will get it.
So a first spike is an entry in a table (``entries.py``). An activation is made when a second spike arrives: in a rule
that writes no slot, for the oldest first spike; in any other rule, for all of them, because consent chooses.

To explain something, to merge groups, and to retire or add a rule, entries are *unfolded* into ordinary activations. As
in a conflict set, their numbers are fixed from the start, and no rival depends on them (`find_halves`). So it does not
matter when an entry unfolds.
"""

from __future__ import annotations

from itertools import islice

from ravestate.engine.activation import Activation
from ravestate.engine.conflict_sets import ConflictSets
from ravestate.engine.deadlines import PATIENCE
from ravestate.engine.group import Group
from ravestate.engine.spike import Spike
from ravestate.policy.model import Clause, Half, Need, SignalPlan


class Halves(ConflictSets):
    """The layer of the engine that offers spikes to halves, and makes their activations."""

    __slots__ = ()

    def unfold_all(self) -> None:
        """Create the activations of all alternatives and entries."""
        super().unfold_all()
        for half, spikes in list(self.halves.items()):
            for spike in list(spikes):
                self.unfold_half(spike, half)

    def unfold_half(self, spike: Spike, half: Half) -> None:
        """Create the activations of the clauses for which a half holds a spike."""
        for need in half.needs:
            if self.keeps(need, spike):
                self._make(need, spike)

    def unfold_clause(self, clause: Clause) -> None:
        """Create the activations of a clause whose halves hold spikes."""
        for need in clause.needs if self.halves else ():
            for spike in list(self.halves.get(need.half, ())) if need.half is not None else ():
                if self.keeps(need, spike):
                    self._make(need, spike)

    def _unfold_group(self, group: Group) -> None:
        """Create the activations of the spikes of a group."""
        for spike in list(group.entries):
            for half in self.halves_of(spike):
                self.unfold_half(spike, half)

    def _make(self, need: Need, spike: Spike) -> Activation:
        """Create the activation of a clause for which a half holds a spike."""
        half = need.half
        assert half is not None
        clause = need.clause
        number = self.halves[half][spike] + half.places[clause.rule.index] + 1
        activation = self._new_activation(clause, number)
        self._acquire(activation, need, spike)
        self._part(spike, need)
        self.lacking.setdefault(clause.needs[1 - need.index], {})[activation] = None
        return activation

    def _offer_to_halves(self, signal: SignalPlan, spike: Spike) -> list[Need]:
        """Offer a new spike to the halves of its signal; return the needs to which it must be offered one by one."""
        others: list[Need] = []
        group = spike.group.root()
        single = self.tracer is not None or self._loops.full
        if single:
            self.unfold_all()
        for half in signal.halves:
            if single or (self.retired and not self.retired.isdisjoint(half.places)):
                others += half.needs
                continue
            first = half.needs[0]
            rule = first.clause.rule
            if not all(self._test(predicate, spike.payload, rule) for predicate in first.predicates):
                continue  # a need with a predicate has a half of its own
            if group.finished(rule.slots):
                continue
            paired: set[int] = set()
            for need in half.needs:
                if need in self.lacking:
                    self._offer_to_lacking(need, spike)
                if self.halves and (group.entries or not half.kin) and self._pair(need, spike, group):
                    paired.add(need.clause.index)
            before = self._activations
            self._activations += len(half.needs)
            if len(paired) < len(half.needs):
                if paired:
                    spike.parted = paired | (spike.parted or set())
                self._enter(spike, half, before)
                self._inherit_pressure(spike, half, group)
        if group.interested:
            self._dirty[group] = None
        return others

    def _pair(self, need: Need, spike: Spike, group: Group) -> bool:
        """Make the activations that a new spike completes; return whether the spike needs no entry for the clause."""
        partner = need.clause.needs[1 - need.index]
        waiting = self.halves.get(partner.half) if partner.half is not None else None
        if not waiting:
            return False
        free = not need.clause.rule.slots
        if need.kin != need.bit:
            found = sorted((s for s in group.entries if self.keeps(partner, s)), key=waiting.__getitem__)
        else:
            found = (s for s in waiting if self.keeps(partner, s))
            found = [*islice(found, 1)] if free else [*found]
        for first in found[:1] if free else found:
            activation = self._make(partner, first)
            self._acquire(activation, need, spike)
            self._stir(activation)
            self._update(activation)
        return free and bool(found)

    def _inherit_pressure(self, spike: Spike, half: Half, group: Group) -> None:
        """Make the activation of each clause whose stand-by was under pressure, and is no stand-by any more."""
        for number in group.pressed or ():
            clause = self.policy.clause_plans[number]
            place = half.places.get(clause.rule.index)
            if place is not None and self.keeps(half.needs[place], spike):
                self._take_over(self._make(half.needs[place], spike), group)

    def _take_over(self, activation: Activation, group: Group) -> None:
        """Put a clause's activation under the pressure that its stand-by had in a group, if it had any (L16)."""
        until = (group.pressed or {}).get(activation.clause.index)
        if until is not None:
            activation.pressed = {group: until}
            if until > self.now:
                self._deadlines.add(until, PATIENCE, (group, activation))
