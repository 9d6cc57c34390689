"""Runs: a rule's function starts, is watched for its `until` condition, and ends (laws L17, L18, L21)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from ravestate.declare.wording import said
from ravestate.engine import events, trace
from ravestate.engine.activation import CANCEL, GRANT, NEVER, RUNNING, Activation
from ravestate.engine.conflict_sets import ConflictSets
from ravestate.engine.deadlines import TIMEOUT, WATCH
from ravestate.engine.effects import Cancel, CancelReason, Ended, Run
from ravestate.engine.group import NOTHING, Group
from ravestate.engine.holdings import Holdings
from ravestate.engine.loops import MANY, TURNS
from ravestate.engine.outcomes import DONE, FAILED, RESIGNED, verdict
from ravestate.engine.spike import Spike
from ravestate.engine.state import State
from ravestate.engine.watch import Watch
from ravestate.errors import RuleError, RuleTimeout
from ravestate.policy.model import RulePlan


class Runs:
    """The part of the engine that starts, cancels and settles runs."""

    __slots__ = ("holdings", "sets", "state")

    def __init__(self, state: State, holdings: Holdings, sets: ConflictSets) -> None:
        self.state = state
        self.holdings = holdings
        self.sets = sets

    def start(self, activation: Activation) -> None:
        """Start an activation: it takes its slots in its groups, and its function runs (L17)."""
        state = self.state
        clause = activation.clause
        rule = clause.rule
        activation.step(GRANT)
        if activation.refusal is not None:
            self.holdings.waits.end(activation)
            if state.tracer is not None:
                self.holdings.waits.tell_followers()
        activation.patience_ends = NOTHING
        activation.stands_on = activation.firm_spikes()
        if rule.slots:
            groups = activation.firm_groups()
            activation.groups = tuple(groups)
            for group in groups:
                for slot in rule.slots:
                    group.take(slot, (activation,))
        elif len(clause.needs) > 1 or len(rule.clauses) > 1:
            self.holdings.give_up(activation, "consumed")  # L10
        state.runs += 1
        activation.number = state.runs
        state.running[state.runs] = activation
        loops = state.loops
        loops.runs += 1
        if rule.timeout is not None:
            activation.deadline = state.now + rule.timeout
            state.deadlines.add(activation.deadline, TIMEOUT, activation)
        for until in rule.until:
            if state.watches is NOTHING:
                state.watches = {}
            state.watches.setdefault(until, {})[activation] = Watch(activation, until)
        payloads: dict[str, Any] = {}
        for spike in activation.spikes:
            if spike is not None:
                payloads[spike.signal.name] = spike.payload
                if spike.origin is not None:
                    activation.origin = _origin(activation)
        if loops.runs > MANY and (loop := loops.find(activation)):
            state.fail(loop[0], RuleError(_endless(loop)), signal=True, origin=activation.origin)
        values: dict[str, Any] = {}
        for view in rule.views:
            values[view.name] = state.read(view.index)
        if state.tracer is not None:
            ids = tuple([spike.id for spike in activation.spikes if spike is not None])
            state.tracer(trace.Started(state.now, activation.id, rule.name, clause.number, ids, activation.number))
        state.acts = True
        state.out.append(Run(activation.number, rule.rule, payloads, values, activation.origin))

    def cancel(self, run: Activation, reason: CancelReason) -> None:
        """Cancel a run, and order the runtime to stop its function."""
        state = self.state
        run.step(CANCEL)
        run.told = reason
        run.deadline = NEVER
        if state.tracer is not None:
            state.tracer(trace.Told(state.now, run.id, run.clause.rule.name, reason))
        state.acts = True
        state.out.append(Cancel(run.number, reason))

    # ------------------------------------------------------------------------------------ until

    def watch(self, spike: Spike) -> None:
        """Offer a new spike to the `until` conditions of runs (L21)."""
        state = self.state
        for need in spike.signal.watchers:
            for run, watch in list(state.watches.get(need.clause, {}).items()):
                if run.state == RUNNING and state.accepts(need, spike.payload):
                    held = watch.spikes[need.index]
                    if held is None or not need.min_age or held.born + need.max_age < state.now:
                        watch.spikes[need.index] = spike  # else keep the older spike, which is old enough earlier
                        if state.watched_by is NOTHING:
                            state.watched_by = {}
                        state.watched_by.setdefault(spike, {})[watch] = None
                        if held is not None and held not in watch.spikes:
                            self._unwatch(watch, held)
                    self.judge(watch)

    def judge(self, watch: Watch) -> None:
        """Interrupt a run if the condition of its watch is met, or set the time at which it will be met (L21)."""
        state = self.state
        due = watch.met_at(state.now)
        if due is None or watch.run.state != RUNNING:
            return
        if due > state.now:
            watch.due = due
            state.deadlines.add(due, WATCH, watch)
        elif state.is_open(watch.clause):
            self.cancel(watch.run, "interrupted")

    def _unwatch(self, watch: Watch, spike: Spike) -> None:
        """Record that a watch no longer keeps a spike."""
        watches = self.state.watched_by.get(spike, {})
        watches.pop(watch, None)
        if not watches:
            self.state.watched_by.pop(spike, None)

    # ------------------------------------------------------------------------------------ the end

    def finish(self, run: Activation, kind: events.OutcomeKind, reason: str, exception: BaseException | None) -> None:
        """Settle a run whose function has ended (L18). `verdict` decides its outcome."""
        state = self.state
        del state.running[run.number]
        rule = run.clause.rule
        outcome, fired = verdict(run.told, kind, run.wrote) if run.told or kind != DONE else (DONE, True)
        if run.told == "timeout":
            late = f"rule {rule.name} took longer than its timeout of {rule.timeout:g} s ({rule.rule.origin})"
            exception = RuleTimeout(late)
        elif outcome == FAILED and kind == RESIGNED:
            written = ", ".join(state.policy.slot_plans[slot].name for slot in rule.slots)
            exception = RuleError(
                f"rule {rule.name} resigned after it had written {written}: resign before the first write"
            )
        if rule.cooldown and fired:
            self._begin_recovery(rule)
        for clause in rule.until:
            self._end_watch(run, state.watches[clause].pop(run))
        if fired:
            self._consume(run)
        else:
            self._relinquish(run)
        if state.tracer is not None:
            text = reason or (said(exception) if exception is not None else "")
            state.tracer(trace.Settled(state.now, run.id, rule.name, outcome, text, fired, exception))
        if state.report_ends:
            state.out.append(Ended(run.number, rule.name, outcome, fired))
        on_error = outcome == FAILED and _handles_error(run)
        self.holdings.end(run)
        if outcome == FAILED:
            failure = exception or RuleError(f"rule {rule.name} failed")
            state.fail(rule, failure, signal=not on_error, lineage=state.loops.lineage(run), origin=run.origin)

    def _begin_recovery(self, rule: RulePlan) -> None:
        """Record that a run of a rule with a cooldown has fired.

        The activations whose order this changes ask again (L9, L15).
        """
        state = self.state
        if state.ran is NOTHING:
            state.ran = state.standing.ran = {}
        state.ran[rule.index] = state.now
        state.reordered = True
        for waiter in state.waiting:
            if waiter.clause.rule is rule or (waiter.refusal is not None and rule.name in waiter.refusal.names):
                state.asking[waiter] = None

    def _end_watch(self, run: Activation, watch: Watch) -> None:
        for spike in watch.spikes:
            if spike is not None:
                self._unwatch(watch, spike)
        if not self.state.watches[watch.clause]:
            del self.state.watches[watch.clause]

    def _consume(self, run: Activation) -> None:
        """Settle a run that fired (L18): it takes its slots in its groups for good.

        Other activations that write one of these slots give up their spikes of these groups.
        """
        state = self.state
        rule = run.clause.rule
        if not rule.slots:
            return
        groups = _roots(run)
        for group in groups:
            if state.tracer is not None:
                group.note(rule.slots, rule.name, run.id)
            for slot in rule.slots:
                group.take(slot, None)
        for group in groups:
            for spike in list(group.entries) if state.benches else ():
                self.holdings.benches.unbench(spike)
            for other in list(group.writers(rule.slots, state.causes)) if group.count > 1 else ():
                if (
                    other is not run
                    and other.state < RUNNING
                    and not other.clause.rule.slotset.isdisjoint(rule.slotset)
                ):
                    self.holdings.lose_group(other, group, "consumed", run)
            for spike in list(group.entries) if group.entries else ():
                if spike in state.benches:
                    self.holdings.benches.check(spike)
                for half in state.halves_of(spike):
                    if not half.slotset.isdisjoint(rule.slotset):
                        self.holdings.entries.drop(spike, half)
            state.dirty[group] = None

    def _relinquish(self, run: Activation) -> None:
        """Settle a run that did not fire (L18): it resigned, failed before a write, or was wiped before a write.

        Free the run's slots, and make its rule give up the run's spikes. If the run's clause competed with others for a
        single spike, let the next of them ask (``conflict_sets.py``).
        """
        for group in _roots(run):
            for slot in run.clause.rule.slots:
                group.free(slot, run)
            self.state.dirty[group] = None
        for spike in run.stands_on if self.state.alternatives else ():
            for other in list(spike.holders):  # else the alternatives of `other` would be lost with the spike
                if other.clause.rule is run.clause.rule and other is not run and other in self.state.alternatives:
                    self.sets.unfold(other)
        self.holdings.give_up(run, "resigned")
        self.sets.substitute(run)


def _origin(run: Activation) -> Any:
    """Return the origin of a run: the origin of its youngest spike that has an origin.

    A spike for a detached constraint counts only if no other spike has an origin (L19).
    """
    known = [spike for spike in run.stands_on if spike.origin is not None]
    looked = [spike for spike in run.spikes if spike is not None and spike.origin is not None]
    return max(known or looked, key=_birth).origin


def _birth(spike: Spike) -> int:
    return spike.id


def _roots(run: Activation) -> list[Group]:
    """Return the groups to which the run's groups belong now, each once."""
    if len(run.groups) == 1:
        return [run.groups[0].root()]
    return list(dict.fromkeys([group.root() for group in run.groups]))


def _handles_error(run: Activation) -> bool:
    """Return whether a run holds a spike of ``core:error``, or a descendant of one. If so, a failure of the run does
    not raise ``core:error`` again."""
    return any(spike is not None and spike.comes_from("core:error") for spike in run.spikes)


def _endless(rules: Sequence[RulePlan]) -> str:
    """Return the error message about an endless loop of `rules`."""
    names = ", ".join(rule.name for rule in rules)
    whom = "each other" if len(rules) > 1 else "itself"
    return (
        f"an endless loop: {names} triggered {whom} {MANY + TURNS:,} times within one instant; add "
        ".min_age(seconds) to a signal of the loop, so that time passes"
    )
