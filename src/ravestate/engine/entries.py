"""Entries: the spikes that halves hold without an activation, and the spikes that nothing holds any more (L12, L23)."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Sequence

from ravestate.engine.activation import NEVER
from ravestate.engine.deadlines import EXPIRE, FORGET
from ravestate.engine.spike import Spike
from ravestate.engine.state import State
from ravestate.policy.model import Half, Need, RulePlan


class Entries(State):
    """The layer of the engine that keeps the table of the halves."""

    __slots__ = ()

    def _enter(self, spike: Spike, half: Half, before: int) -> None:
        """Let a half hold a spike; `before` is the activation number just before theirs."""
        held = self.halves.get(half)
        if held is None:
            held = self.halves[half] = OrderedDict()
        held[spike] = before
        spike.entries += 1
        self._busy += half.busy
        if half.slotset or half.kin:
            spike.group.root().enter(spike)
        if half.max_age != NEVER:
            self._let_expire(spike, spike.born + half.max_age)

    def keeps(self, need: Need, spike: Spike) -> bool:
        """Return whether the need's half holds a spike for the need's clause."""
        held = self.halves.get(need.half) if need.half is not None else None
        return held is not None and spike in held and not (spike.parted and need.clause.index in spike.parted)

    def halves_of(self, spike: Spike) -> Sequence[Half]:
        """Return the halves that hold a spike."""
        return [half for half in spike.signal.halves if spike in self.halves.get(half, ())] if spike.entries else ()

    def _part(self, spike: Spike, need: Need) -> None:
        """Note that the need's half holds a spike no longer for the need's clause."""
        half = need.half
        if half is None or spike not in self.halves.get(half, ()):
            return
        if spike.parted is None:
            spike.parted = set()
        spike.parted.add(need.clause.index)
        if len(half.needs) <= len(spike.parted) and all(n.clause.index in spike.parted for n in half.needs):
            self._drop(spike, half)

    def _drop(self, spike: Spike, half: Half) -> None:
        """Make a half give a spike up for all its clauses."""
        held = self.halves[half]
        del held[spike]
        if not held:
            del self.halves[half]
        spike.entries -= 1
        self._busy -= half.busy
        group = spike.group.root()
        if not spike.entries:
            group.leave(spike)
        if half.slotset and group.interested:
            self._dirty[group] = None
        if not (spike.holders or spike.entries):
            self._forget(spike)

    def _refuse_for_good(self, spike: Spike, rule: RulePlan) -> None:
        """Make a rule give a spike up for good."""
        spike.refuse(rule.index)
        if spike.entries and len(rule.clauses) == 1:
            for need in rule.clauses[0].needs:
                if need.signal is spike.signal:
                    self._part(spike, need)

    def _let_expire(self, spike: Spike, due: float) -> None:
        """Set the time (seconds) at which holders that are still incomplete give the spike up (L14)."""
        if due <= self.now or due not in spike.expiring:
            spike.expiring = (*spike.expiring, due)
            self._deadlines.add(due, EXPIRE, spike)

    def _forget(self, spike: Spike) -> None:
        """Remove a spike that nothing holds, unless detached needs may still look at it."""
        signal = spike.signal
        if signal.retain >= 0 and spike.born + signal.retain > self.now:
            if signal.retain != NEVER:
                self._deadlines.add(spike.born + signal.retain, FORGET, spike)
            return
        live = self.live.get(signal.index)
        if live is not None:
            live.pop(spike, None)
            if not live:
                del self.live[signal.index]
        if spike.group.root().interested:
            self._dirty[spike.group.root()] = None

    def on_forget(self, time: float, spike: Spike) -> None:
        """Remove a spike that is too old for every detached need, if nothing holds it."""
        if not (spike.holders or spike.entries):
            self._forget(spike)
