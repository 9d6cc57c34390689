"""Holdings: activations take spikes and give them up, and so become ready or end (L12, L14, L20, L23)."""

from __future__ import annotations

from collections.abc import Iterable

from ravestate.engine import trace
from ravestate.engine.activation import (
    COMPLETE,
    END,
    GATHERING,
    LOSE,
    NEVER,
    READY,
    RUNNING,
    WAITING,
    Activation,
)
from ravestate.engine.deadlines import RIPEN
from ravestate.engine.entries import Entries
from ravestate.engine.group import NOTHING, Group
from ravestate.engine.loops import MANY
from ravestate.engine.spike import Spike
from ravestate.policy.model import Clause, Need, SignalPlan


class Holdings(Entries):
    """The layer of the engine that gives spikes to activations and takes them away."""

    __slots__ = ()

    def _look(self, activation: Activation, needs: Iterable[Need]) -> None:
        """For each detached need without a spike, take the newest live spike that fits, old enough if possible."""
        for need in needs:
            if not need.bit & activation.missing:
                continue
            live = self.live.get(need.signal.index)
            if not live:
                continue
            if need.detached:
                best: Spike | None = None
                for spike in reversed(live):
                    if self._fits(need, spike):
                        best = spike  # if all spikes are too young, the oldest ripens first
                        if spike.born + need.min_age <= self.now:
                            break
                if best is not None:
                    self._acquire(activation, need, best)

    def _offer_to_lacking(self, need: Need, spike: Spike) -> None:
        """Offer a new spike to every activation that lacks it, oldest first (L12)."""
        lacking = self.lacking[need]
        for activation in sorted(lacking, key=_age) if len(lacking) > 1 else tuple(lacking):
            if need.kin != need.bit and not self._coherent(activation, need, spike):
                continue
            if activation.missing & need.bit:  # an earlier offer may have met the need
                self._acquire(activation, need, spike)
                self._stir(activation)
                self._update(activation)

    def _swap(self, activation: Activation, need: Need, spike: Spike) -> None:
        """Let a detached need hold another spike."""
        self._release(activation, need, "")
        self._acquire(activation, need, spike)
        if activation.state is GATHERING:
            self._update(activation)

    def _rematch(self, activation: Activation, need: Need) -> None:
        """For a need that has lost its spike, take the oldest live spike that fits, if there is such a spike (L12)."""
        if need.detached:
            self._look(activation, (need,))
        else:
            for spike in self.live.get(need.signal.index, ()):
                if self._fits(need, spike) and self._coherent(activation, need, spike):
                    self._acquire(activation, need, spike)
                    return

    def _coherent(self, activation: Activation, need: Need, spike: Spike) -> bool:
        """Return whether a spike belongs to the causal group from which the activation meets the kin needs (L12)."""
        if need.kin == need.bit:
            return True
        held = activation.held(need.kin & ~need.bit)
        return held is None or held.group.root() is spike.group.root()

    def _acquire(self, activation: Activation, need: Need, spike: Spike) -> None:
        """Give an activation a spike that meets one of its needs."""
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

    def _pass_by(self, clause: Clause, spike: Spike, reason: str) -> None:
        """Record in the trace that a rule hears a spike's signal but does not take the spike, for a `reason`."""
        if self.tracer is not None:
            rule = clause.rule
            by, run = spike.group.root().answer(rule.slots) if reason == "consumed" else ("", 0)
            self.tracer(trace.Passed(self.now, rule.name, clause.number, spike.id, spike.signal.name, reason, by, run))

    def _update(self, activation: Activation) -> None:
        """After an activation's spikes have changed or aged, complete it, or else set its deadlines (L14)."""
        clause = activation.clause
        if not activation.missing:
            ripens = -NEVER
            for need in clause.needs:
                if need.min_age:
                    spike = activation.spikes[need.index]
                    ripens = max(ripens, spike.born + need.min_age)  # type: ignore[union-attr]  # nothing is missing
            if ripens <= self.now:
                if activation.ripens != NEVER:
                    activation.ripens = NEVER
                if not clause.guards or all(self.holds(s, g, clause.rule) for s, g in clause.guards):
                    self.gated.pop(activation, None)
                    self._complete(activation)
                    return
                self.gated[activation] = None
            elif activation.ripens != ripens:
                activation.ripens = ripens
                self._deadlines.add(ripens, RIPEN, activation)
        for need in clause.needs:
            spike = activation.spikes[need.index]
            if spike is not None and need.max_age != NEVER:
                self._let_expire(spike, spike.born + need.max_age)

    def on_expire(self, time: float, spike: Spike) -> None:
        """Make incomplete holders give up a spike that is too old for them (L14)."""
        for holder in list(spike.holders):
            if holder.state is GATHERING:
                old = [need for need in self._of_spike(holder, spike) if spike.born + need.max_age <= time]
                self._lose(holder, old, "age")
        for half in self.halves_of(spike):
            if spike.born + half.max_age <= time:
                self._drop(spike, half)

    def on_ripen(self, time: float, activation: Activation) -> None:
        """Judge an activation again whose spikes are old enough now (L14)."""
        activation.ripens = NEVER
        self._update(activation)

    def _complete(self, activation: Activation, *, late: bool = False) -> None:
        """Make an activation ready and queue it: a writer asks for consent, and any other activation starts without it.

        If the activation's loop has had too many turns (L23), only a second call, with `late`, queues the activation.
        """
        if not late:
            activation.step(COMPLETE)
            if self._loops.runs > MANY and self._loops.defer(activation):
                return
        clause = activation.clause
        if clause.rule.slots and clause.firm_bits:
            self._asking[activation] = None
        else:
            self._free.new.append(activation)

    def _release(self, activation: Activation, need: Need, reason: str, by: Activation | None = None) -> None:
        """Take the spike of a need from an activation; `by` is the run that is the reason, or None."""
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
        if spike not in activation.spikes:
            spike.holders.pop(activation, None)
            if not (spike.holders or spike.entries):
                self._forget(spike)
        if reason and self.tracer is not None:
            self.tracer(
                trace.GaveUp(
                    self.now,
                    activation.id,
                    activation.clause.rule.name,
                    spike.id,
                    spike.signal.name,
                    reason,
                    "" if by is None else by.clause.rule.name,
                    0 if by is None else by.id,
                )
            )

    def _lose(self, activation: Activation, needs: Iterable[Need], reason: str, by: Activation | None = None) -> None:
        """Make an activation give up the spikes of `needs`; end it if no spike that keeps it alive is left."""
        needs = [need for need in needs if not need.bit & activation.missing]
        if not needs:
            return
        clause = activation.clause
        left = clause.all_bits & ~activation.missing
        for need in needs:
            left &= ~need.bit
        if not left or (clause.asks_detached and not left & clause.firm_bits):
            self._end(activation, reason, by)
            return
        for need in needs:
            self._release(activation, need, reason, by)
        self._stir(activation)
        self._unready(activation)
        for need in needs:
            self.lacking.setdefault(need, {})[activation] = None
        kin = 0
        for need in needs:
            kin |= need.kin
        # The lost spike may have excluded spikes of other groups, which may now meet the kin needs.
        for need in (*needs, *(n for n in clause.needs if n.bit & kin)):
            if need.bit & activation.missing:
                self._rematch(activation, need)
        self._update(activation)

    def _stir(self, activation: Activation) -> None:
        """Make the activations that wait for this one ask again, because its spikes have changed."""
        for group in activation.firm_groups():
            if group.interested:
                self._dirty[group] = None
        if self.hoping:
            self.stir_rule(activation.clause.rule)

    def _unready(self, activation: Activation) -> None:
        """Put a ready or waiting activation back into the state `GATHERING`."""
        activation.step(LOSE)
        activation.ripens = NEVER
        if activation.interests:
            self._lose_interest(activation)
        self._asking.pop(activation, None)
        self.gated.pop(activation, None)

    def _end(self, activation: Activation, reason: str = "", by: Activation | None = None) -> None:
        """End an activation and remove every reference to it. With a `reason`, trace that it gave its spikes up."""
        before = activation.state
        activation.step(END)
        clause = activation.clause
        missing = activation.missing
        for need in clause.needs:
            if need.bit & missing:
                lacking = self.lacking[need]
                del lacking[activation]
                if not lacking:
                    del self.lacking[need]
            else:
                self._release(activation, need, reason, by)
        if before is GATHERING:
            self.gated.pop(activation, None)
            if activation.ripens != NEVER:
                activation.ripens = NEVER
        elif before is READY:
            self._asking.pop(activation, None)
        elif before is WAITING:
            self._asking.pop(activation, None)
            self._lose_interest(activation)
            activation.recheck = NEVER
            activation.blockers = activation.firm = ()
        else:
            activation.deadline = NEVER
            activation.stands_on = activation.groups = ()
        if activation.pressed:
            activation.pressed = NOTHING
        if self.alternatives:
            self.alternatives.pop(activation, None)
        active = self.active[clause.rule.index]
        del active[activation]
        if not active:
            del self.active[clause.rule.index]
        if self.hoping:
            self.stir_rule(clause.rule)
        if not (clause.rule.background or clause.reflexive):
            self._busy -= 1

    def _lose_interest(self, activation: Activation) -> None:
        """Make an activation stop waiting, so that changes in its groups do not make it ask again."""
        self.waiting.pop(activation, None)
        self._refused.pop(activation, None)
        if self._stuck:
            self._stuck.pop(activation, None)
        for hope in activation.hopes:
            hoping = self.hoping.get(hope)
            if hoping is not None:
                hoping.pop(activation, None)
                if not hoping:
                    del self.hoping[hope], self._hope_counts[hope]
        activation.hopes = ()
        for group in activation.interests:
            group.root().forget(activation)
        activation.interests = ()

    def _kill(self, spike: Spike, reason: str) -> None:
        """Withdraw a spike (L20): activations give it up, but a run that started with the spike keeps it."""
        if self.tracer is not None:
            self.tracer(trace.Dropped(self.now, spike.id, spike.signal.name, reason))
        live = self.live.get(spike.signal.index)
        if live is not None:
            live.pop(spike, None)
            if not live:
                del self.live[spike.signal.index]
        for watch in self._watched_by.pop(spike, ()):
            watch.lose(spike)
        for half in self.halves_of(spike):
            self._drop(spike, half)
        for holder in list(spike.holders):
            if holder.state < RUNNING:
                self._lose(holder, self._of_spike(holder, spike), "withdrawn")
            else:
                self.alternatives.pop(holder, None)  # each alternative would have given the spike up

    def _withdraw(self, signal: SignalPlan, reason: str) -> None:
        """Withdraw all live spikes of a signal, for a `reason`."""
        live = self.live.get(signal.index)
        if live or self._watched_by:
            watched = [s for s in self._watched_by if s.signal is signal and (not live or s not in live)]
            for spike in [*(live or ()), *watched]:
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

    def _give_up(self, run: Activation, spikes: tuple[Spike, ...], reason: str) -> None:
        """Make the run's rule give up `spikes` for good, in all its other activations."""
        rule = run.clause.rule
        for spike in spikes:  # mark all of them first: an activation that loses a spike looks for another at once
            self._refuse_for_good(spike, rule)
        for spike in spikes:
            for other in list(spike.holders) if len(spike.holders) > 1 else ():
                if other is not run and other.clause.rule is rule and other.state < RUNNING:
                    self._lose(other, [n for n in self._of_spike(other, spike) if not n.detached], reason, run)


def _age(activation: Activation) -> int:
    return activation.id
