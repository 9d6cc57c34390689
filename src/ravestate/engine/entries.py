"""The tables of live spikes and of *halves* (laws L12, L14, L23).

A clause with two constraints, its *needs*, takes two spikes. A half keeps the first spike, without an activation, until
the second spike comes. One half does this for all clauses that the engine can treat alike (``halves.py``). An *entry*
is a spike that a half keeps. A *bench* is a table of entries that wait for the same second spike, the *counterpart*, or
share it already (``benches.py``). A *detached* need looks at a spike without consuming it.
"""

from __future__ import annotations

from collections import OrderedDict

from ravestate.engine.activation import NEVER
from ravestate.engine.bench import Bench
from ravestate.engine.deadlines import EXPIRE, FORGET
from ravestate.engine.group import NOTHING
from ravestate.engine.spike import Spike
from ravestate.engine.state import State
from ravestate.policy.model import Half, Need, RulePlan


class Entries:
    """The part of the engine that keeps the tables of live spikes and halves."""

    __slots__ = ("state",)

    def __init__(self, state: State) -> None:
        self.state = state

    def enter(self, spike: Spike, half: Half, before: int) -> None:
        """Let a half hold a spike. If the spike gets activations later, they are numbered from `before` + 1 on."""
        state = self.state
        held = state.halves.get(half)
        if held is None:
            if state.halves is NOTHING:
                state.halves, state.pools, state.seats = {}, {}, {}
            held = state.halves[half] = OrderedDict()
            if half.sole:
                state.pools[half] = Bench(half, held)
        held[spike] = before
        if half.sole:
            state.seats.setdefault(half, {})[spike] = state.pools[half]
        spike.in_halves += 1
        state.busy += half.busy
        if half.slotset or half.kin:
            spike.group.root().enter(spike)
        if half.max_age != NEVER:
            self.let_expire(spike, spike.born + half.max_age)

    def part(self, spike: Spike, need: Need) -> None:
        """Make a half give a spike up for one clause, the clause of `need`. If no clause is left, drop the spike."""
        half = need.half
        if half is None or self.state.entries(half, spike) is None:
            return
        if spike.parted is None:
            spike.parted = set()
        spike.parted.add(need.clause.index)
        if len(half.needs) <= len(spike.parted) and all(n.clause.index in spike.parted for n in half.needs):
            self.drop(spike, half)

    def drop(self, spike: Spike, half: Half) -> None:
        """Make a half give a spike up for all its clauses."""
        state = self.state
        if half.sole:
            self._leave(spike, half)
        else:
            held = state.halves[half]
            del held[spike]
            if not held:
                del state.halves[half]
                if half in state.rows:
                    del state.rows[half]
        spike.in_halves -= 1
        state.busy -= half.busy
        if state.patience_ends:
            pressed = state.patience_ends.get(spike, {})
            pressed.pop(half, None)
            if not pressed:
                state.patience_ends.pop(spike, None)
        group = spike.group.root()
        if not spike.in_halves:
            group.leave(spike)
        if half.slotset and group.interested:
            state.dirty[group] = None
        if not (spike.is_held or spike.in_halves):
            self.forget(spike)

    def _leave(self, spike: Spike, half: Half) -> None:
        """Remove a spike from its bench."""
        state = self.state
        seats = state.seats[half]
        bench = seats.pop(spike)
        if not seats:
            del state.seats[half]
        del bench.spikes[spike]
        if not bench.spikes:
            if bench.partner is None:
                del state.halves[half], state.pools[half]
            else:
                self.vacate(bench)

    def vacate(self, bench: Bench) -> None:
        """Remove the counterpart of a bench."""
        state, partner = self.state, bench.partner
        assert partner is not None
        bench.partner = None
        benches = state.benches[partner]
        del benches[bench.half]
        if not benches:
            del state.benches[partner]
        partner.in_halves -= 1
        if not partner.in_halves:
            partner.group.root().leave(partner)
            if not partner.is_held:
                self.forget(partner)

    def refuse_for_good(self, spike: Spike, rule: RulePlan) -> None:
        """Record that a rule gives a spike up for good, and take the spike from its half. Activations keep it."""
        spike.refuse(rule.index)
        if spike.in_halves and len(rule.clauses) == 1:
            for need in rule.clauses[0].needs:
                if need.signal is spike.signal:
                    self.part(spike, need)

    def refuse_best(self, spike: Spike, half: Half, begin: int, end: int) -> bool:
        """Make the rules of the needs `half.best[begin:end]` give a spike up for good.

        Return whether the half held the spike for one of these needs.
        """
        parted, refused = spike.parted or set(), spike.refused or set()
        needs = [need for need in half.best[begin:end] if need.clause.index not in parted]
        if not needs:
            return False
        refused.update([need.clause.rule.index for need in needs])
        parted.update([need.clause.index for need in needs])
        spike.parted, spike.refused = parted, refused
        if parted.issuperset(half.rank):
            self.drop(spike, half)
        return True

    def let_expire(self, spike: Spike, due: float) -> None:
        """Add a time (seconds) at which holders that are not ready yet give the spike up (L14).

        The holders are activations, and halves without a second spike.
        """
        if due <= self.state.now or due not in spike.expiring:
            spike.expiring = (*spike.expiring, due)
            self.state.deadlines.add(due, EXPIRE, spike)

    def forget(self, spike: Spike) -> None:
        """Remove a spike that nothing holds, unless detached needs may still look at it."""
        state = self.state
        signal = spike.signal
        if signal.retain >= 0 and spike.born + signal.retain > state.now:
            if signal.retain != NEVER:
                state.deadlines.add(spike.born + signal.retain, FORGET, spike)
            return
        self.remove(spike)
        group = spike.group if spike.group.into is None else spike.group.root()
        if group.interested:
            state.dirty[group] = None

    def remove(self, spike: Spike) -> None:
        """Remove a spike from the table of live spikes."""
        live = self.state.live.get(spike.signal.index)
        if live is not None:
            if spike in live:
                del live[spike]
            if not live:
                del self.state.live[spike.signal.index]
