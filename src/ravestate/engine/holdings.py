"""Holdings: activations take spikes and give them up, and so become ready or end (laws L12, L14, L20, L23).

A *need* is one constraint of a clause: one spike meets it. A detached need looks at a spike without consuming it.
"""

from __future__ import annotations

from collections.abc import Iterable

from ravestate.engine import trace
from ravestate.engine.activation import (
    COMPLETE,
    END,
    ENDED,
    GATHERING,
    LOSE,
    NEVER,
    READY,
    RUNNING,
    WAITING,
    Activation,
    by_age,
)
from ravestate.engine.benches import Benches
from ravestate.engine.deadlines import PATIENCE, RIPEN
from ravestate.engine.entries import Entries
from ravestate.engine.group import NOTHING, Group
from ravestate.engine.loops import MANY
from ravestate.engine.spike import Spike
from ravestate.engine.state import State
from ravestate.engine.waits import Waits
from ravestate.policy.model import Clause, Need, SignalPlan


class Holdings:
    """The part of the engine that gives spikes to activations and takes them away."""

    __slots__ = ("benches", "entries", "state", "waits")

    def __init__(self, state: State, entries: Entries, waits: Waits) -> None:
        self.state = state
        self.entries = entries
        self.waits = waits
        self.benches = Benches(self)

    def new_activation(self, clause: Clause, number: int) -> Activation:
        """Create an activation of a clause. The caller gives it its first spike."""
        state = self.state
        activation = Activation(number, clause)
        rule = clause.rule
        active = state.active.get(rule.index)
        if active is None:
            active = state.active[rule.index] = {}
        active[activation] = None
        if not (rule.background or clause.reflexive):
            state.busy += 1
        if state.hoping:
            self.waits.stir_rule(rule)
        return activation

    def put_under_pressure(self, activation: Activation, group: Group, until: float) -> None:
        """Give a new activation a patience that ends in a group at `until` (seconds; L16).

        The activation's clause was already under pressure there: either without a spike, or with a spike that a half
        kept without an activation (``halves.py``).
        """
        activation.patience_ends = {group: until}
        if until > self.state.now:
            self.state.deadlines.add(until, PATIENCE, (group, activation))

    # ------------------------------------------------------------------------------------ taking

    def acquire(self, activation: Activation, need: Need, spike: Spike) -> None:
        """Give an activation a spike that meets one of the activation's needs."""
        state = self.state
        activation.put(need, spike)
        activation.missing &= ~need.bit
        spike.hold(activation)
        if not need.detached:
            group = spike.group if spike.group.into is None else spike.group.root()
            group.join(activation)
        if len(activation.clause.needs) > 1:
            lacking = state.lacking.get(need)
            if lacking is not None:
                lacking.pop(activation, None)
                if not lacking:
                    del state.lacking[need]
        if state.tracer is not None:
            self._trace_held(activation, spike)

    def offer_to_lacking(self, need: Need, spike: Spike) -> None:
        """Offer a new spike to every activation that lacks a spike for a need, oldest first (L12)."""
        lacking = self.state.lacking[need]
        for activation in sorted(lacking, key=by_age) if len(lacking) > 1 else tuple(lacking):
            if need.kin != need.bit and not self.is_coherent(activation, need, spike):
                continue
            if activation.missing & need.bit:  # an earlier offer may have met the need
                self.acquire(activation, need, spike)
                self.waits.stir(activation)
                self.update(activation)

    def is_coherent(self, activation: Activation, need: Need, spike: Spike) -> bool:
        """Return whether a spike may join the spikes that an activation holds for the `kin` of a need.

        Kin needs of a clause may only hold spikes of one causal group (L12).
        """
        if need.kin == need.bit:
            return True
        held = activation.held(need.kin & ~need.bit)
        return held is None or held.group.root() is spike.group.root()

    def look(self, activation: Activation, needs: Iterable[Need]) -> None:
        """For each detached need without a spike, take the newest spike that fits and is old enough.

        If all fitting spikes are too young, take the oldest of them.
        """
        state = self.state
        for need in needs:
            if not need.detached or not need.bit & activation.missing:
                continue
            best: Spike | None = None
            for spike in reversed(state.live.get(need.signal.index, {})):
                if state.fits(need, spike):
                    best = spike  # if all spikes are too young, the oldest will be old enough first
                    if spike.born + need.min_age <= state.now:
                        break
            if best is not None:
                self.acquire(activation, need, best)

    def swap(self, activation: Activation, need: Need, spike: Spike) -> None:
        """Give a need another spike in place of its present one."""
        self._release(activation, need, "")
        self.acquire(activation, need, spike)
        if activation.state == GATHERING:
            self.update(activation)

    def _rematch(self, activation: Activation, need: Need) -> None:
        """If a live spike fits a need that has lost its spike, take the oldest such spike (L12). For a detached need,
        choose the spike as `look` does."""
        if need.detached:
            self.look(activation, (need,))
        else:
            for spike in self.state.live.get(need.signal.index, ()):
                if self.state.fits(need, spike) and self.is_coherent(activation, need, spike):
                    self.acquire(activation, need, spike)
                    return

    # ------------------------------------------------------------------------------------ becoming ready

    def update(self, activation: Activation) -> None:
        """Judge an activation after its spikes have changed or aged: make it ready, or set its deadlines (L14)."""
        state = self.state
        clause = activation.clause
        if not activation.missing:
            ripens = -NEVER
            for need in clause.needs:
                if need.min_age:
                    spike = activation.spike(need)
                    assert spike is not None  # nothing is missing
                    ripens = max(ripens, spike.born + need.min_age)
            if ripens <= state.now:
                activation.ripens = NEVER
                if not clause.guards or state.is_open(clause):
                    state.gated.pop(activation, None)
                    self.complete(activation)
                    return
                if state.gated is NOTHING:
                    state.gated = {}
                state.gated[activation] = None
            elif activation.ripens != ripens:
                activation.ripens = ripens
                state.deadlines.add(ripens, RIPEN, activation)
        for need in clause.needs:
            spike = activation.spike(need)
            if spike is not None and need.max_age != NEVER:
                self.entries.let_expire(spike, spike.born + need.max_age)

    def complete(self, activation: Activation, *, late: bool = False) -> None:
        """Make an activation ready and queue it, to ask for consent or, if it needs no consent, to start.

        If the activation belongs to an endless loop, it may be deferred (L23). If so, only a second call, with `late`,
        queues it.
        """
        state = self.state
        if not late:
            activation.step(COMPLETE)
            if state.loops.runs > MANY and state.loops.defer(activation):
                return
        clause = activation.clause
        if clause.rule.slots and clause.firm_bits:
            state.asking[activation] = None
        else:
            state.free.new.append(activation)

    def unready(self, activation: Activation) -> None:
        """Put an activation that does not run yet back into the state `GATHERING`."""
        activation.step(LOSE)
        self._unhead(activation)
        activation.ripens = NEVER
        if activation.refusal is not None:
            self.waits.end(activation)
        self.state.asking.pop(activation, None)
        self.state.gated.pop(activation, None)

    def _unhead(self, activation: Activation) -> None:
        """If an activation was the head of a bench, note that the bench needs another head.

        A *bench* keeps spikes that share a second spike. Its *head* is the activation of one of these pairs
        (``benches.py``).
        """
        state = self.state
        if state.benches:
            for spike in activation.spikes:
                if spike is not None and spike in state.benches:
                    if state.headless is NOTHING:
                        state.headless = {}
                    state.headless[spike] = None

    def on_expire(self, time: float, spike: Spike) -> None:
        """Make holders that are not ready yet give up a spike that is too old for them (L14)."""
        for holder in spike.holders:
            if holder.state == GATHERING:
                old = [need for need in _of_spike(holder, spike) if spike.born + need.max_age <= time]
                self.lose(holder, old, "age")
        for half in self.state.halves_of(spike):
            if spike.born + half.max_age <= time:
                bench = self.state.bench_of(half, spike)
                if bench is not None and bench.partner is not None:
                    bench.late.append(spike)  # with a counterpart, the spike does not expire
                else:
                    self.entries.drop(spike, half)

    # ------------------------------------------------------------------------------------ giving up

    def lose(self, activation: Activation, needs: Iterable[Need], reason: str, by: Activation | None = None) -> None:
        """Make an activation give up the spikes of `needs`, and end it if nothing keeps it alive.

        An activation that stays alive takes other live spikes instead, if any fit (L12). A spike for a non-detached
        need keeps an activation alive. If all needs of its clause are detached, any spike keeps it alive. `by` is the
        run that is the cause, or None.
        """
        needs = [need for need in needs if not need.bit & activation.missing]
        if not needs:
            return
        clause = activation.clause
        left = clause.all_bits & ~activation.missing
        for need in needs:
            left &= ~need.bit
        if not left or (clause.asks_detached and not left & clause.firm_bits):
            self.end(activation, reason, by)
            return
        for need in needs:
            self._release(activation, need, reason, by)
        self.waits.stir(activation)
        self.unready(activation)
        for need in needs:
            self.state.lacking.setdefault(need, {})[activation] = None
        kin = 0
        for need in needs:
            kin |= need.kin
        # A lost spike tied its kin needs to one causal group. Spikes of other groups may meet these needs now.
        for need in (*needs, *(n for n in clause.needs if n.bit & kin)):
            if need.bit & activation.missing:
                self._rematch(activation, need)
        twins = self._twins(activation)
        youngest = max([activation, *twins], key=by_age)
        if len(twins) > 1:
            self.end(youngest, "doubled")
        if activation.state != ENDED:
            self.update(activation)

    def _twins(self, activation: Activation) -> list[Activation]:
        """Return the other activations of the same clause that are not ready yet, and have the same spikes and
        patience.

        Each further spike is offered to this activation and all the others, but only one of them can consume the
        spikes. While that one waits or runs, another of them may still be a rival of activations outside this set
        (L16). More than two such activations have no use: if the clause never got its last spike, each new spike would
        add another activation (L23).
        """
        if not activation.clause.firm_bits:
            return []  # nothing is consumed, so all may run
        spikes, lacking = activation.spikes, self.state.lacking
        needs = zip(activation.clause.needs, spikes, strict=True)
        found = [lacking[need] if spike is None else spike.holders for need, spike in needs]
        return [
            other
            for other in min(found, key=len)
            if other is not activation
            and other.state == GATHERING
            and other.clause is activation.clause
            and other.spikes == spikes
            and other.patience_ends == activation.patience_ends
        ]

    def lose_group(self, activation: Activation, group: Group, reason: str, by: Activation | None = None) -> None:
        """Make an activation give up the spikes of a group that it holds for non-detached needs."""
        needs: list[Need] = []
        for need in activation.clause.needs:
            spike = activation.spike(need)
            if spike is not None and not need.detached and spike.group.root() is group:
                needs.append(need)
        self.lose(activation, needs, reason, by)

    def give_up(self, run: Activation, reason: str) -> None:
        """Make all other activations of a run's rule give up, for good, the spikes that the run holds for non-detached
        needs."""
        rule = run.clause.rule
        for spike in run.stands_on:  # refuse all spikes first: an activation that loses one spike takes another
            self.benches.unbench(spike)
            self.entries.refuse_for_good(spike, rule)
        for spike in run.stands_on:
            if spike in self.state.benches:
                self.benches.check(spike)
            for other in spike.holders:
                if other is not run and other.clause.rule is rule and other.state < RUNNING:
                    self.lose(other, [n for n in _of_spike(other, spike) if not n.detached], reason, run)

    def end(self, activation: Activation, reason: str = "", by: Activation | None = None) -> None:
        """End an activation and remove every reference to it. With a `reason`, record in the trace each spike that it
        gives up."""
        state = self.state
        before = activation.state
        self._unhead(activation)
        activation.step(END)
        clause = activation.clause
        missing = activation.missing
        for need in clause.needs:
            if need.bit & missing:
                lacking = state.lacking[need]
                del lacking[activation]
                if not lacking:
                    del state.lacking[need]
            else:
                self._release(activation, need, reason, by)
        if before == GATHERING:
            state.gated.pop(activation, None)
            activation.ripens = NEVER
        elif before == READY:
            state.asking.pop(activation, None)
        elif before == WAITING:
            state.asking.pop(activation, None)
            self.waits.end(activation)
        else:
            activation.deadline = NEVER
            activation.stands_on = activation.groups = ()
        activation.patience_ends = NOTHING
        if state.alternatives:
            state.alternatives.pop(activation, None)
        rule = clause.rule
        active = state.active[rule.index]
        del active[activation]
        if not active:
            del state.active[rule.index]
        if state.hoping:
            self.waits.stir_rule(rule)
        if not (rule.background or clause.reflexive):
            state.busy -= 1

    def _release(self, activation: Activation, need: Need, reason: str, by: Activation | None = None) -> None:
        """Make an activation give up the spike of a need; `by` is the run that is the cause, or None.

        The spike's causal group becomes *dirty*: the activations that wait for a change in it ask again (`Waits.wake`).
        """
        state = self.state
        spike = activation.spike(need)
        if spike is None:
            return
        activation.put(need, None)
        activation.missing |= need.bit
        if not need.detached:
            group = spike.group if spike.group.into is None else spike.group.root()
            if len(activation.clause.needs) == 1 or group not in activation.firm_groups():
                group.part(activation)
            if group.interested:
                state.dirty[group] = None
        if not activation.holds(spike) and not (spike.release(activation) or spike.in_halves):
            self.entries.forget(spike)
        if reason and state.tracer is not None:
            rule, run = ("", 0) if by is None else (by.clause.rule.name, by.id)
            mine = activation.clause.rule.name
            state.tracer(trace.GaveUp(state.now, activation.id, mine, spike.id, spike.signal.name, reason, rule, run))

    # ------------------------------------------------------------------------------------ withdrawing

    def kill(self, spike: Spike, reason: str) -> None:
        """Withdraw a spike (L20): activations give it up, but a run that started with the spike keeps it."""
        state = self.state
        if state.tracer is not None:
            state.tracer(trace.Dropped(state.now, spike.id, spike.signal.name, reason))
        self.entries.remove(spike)
        for watch in state.watched_by.pop(spike, ()):
            watch.lose(spike)
        self.benches.unbench(spike)
        for half in state.halves_of(spike):
            self.entries.drop(spike, half)
        if spike in state.benches:
            self.benches.check(spike)
        for holder in spike.holders:
            if holder.state < RUNNING:
                self.lose(holder, _of_spike(holder, spike), "withdrawn")
            else:
                state.alternatives.pop(holder, None)  # the run's alternatives (`ConflictSets`) lose the spike

    def withdraw(self, signal: SignalPlan, reason: str) -> None:
        """Withdraw all live spikes of a signal, for a `reason`."""
        state = self.state
        live = state.live.get(signal.index)
        if live or state.watched_by:
            watched = [s for s in state.watched_by if s.signal is signal and (not live or s not in live)]
            for spike in [*(live or ()), *watched]:
                self.kill(spike, reason)

    # ------------------------------------------------------------------------------------ the trace

    def pass_by(self, clause: Clause, spike: Spike, reason: str) -> None:
        """Record in the trace that a rule hears a spike's signal but does not take the spike, for a `reason`."""
        state = self.state
        if state.tracer is not None:
            rule = clause.rule
            by, run = spike.group.root().answer(rule.slots) if reason == "consumed" else ("", 0)
            state.tracer(
                trace.Passed(state.now, rule.name, clause.number, spike.id, spike.signal.name, reason, by, run)
            )

    def _trace_held(self, activation: Activation, spike: Spike) -> None:
        state, clause = self.state, activation.clause
        if state.tracer is not None:
            lacks = tuple(n.signal.name for n in clause.needs if n.bit & activation.missing)
            rule = clause.rule.name
            state.tracer(trace.Held(state.now, activation.id, rule, clause.number, spike.id, spike.signal.name, lacks))


def _of_spike(activation: Activation, spike: Spike) -> list[Need]:
    """Return the needs of an activation that a spike meets."""
    return [need for need in activation.clause.needs if activation.spike(need) is spike]
