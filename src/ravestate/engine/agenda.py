"""The agenda: the order in which ready activations start, ask for consent, or wait (L15-L17, L22).

1. Rules that write no slot start at once.
2. When none of them is left, ready writers ask for consent (``consent.py``): older causes first, and the greatest
   utility first within a cause. By then, rules that never suspend have ended.
3. When no writer may start either, the engine updates the built-in flags.

So when a classifier ends, a waiting activation asks again in the same instant, but only after everything else that ends
in this instant.
"""

from __future__ import annotations

import heapq
from collections.abc import Sequence
from typing import Any

from ravestate.engine import trace
from ravestate.engine.activation import GRANT, NEVER, READY, REFUSE, RUNNING, WAITING, Activation
from ravestate.engine.consent import Refusal, ask, stalemate
from ravestate.engine.deadlines import PATIENCE, RECHECK, TIMEOUT
from ravestate.engine.effects import Run
from ravestate.engine.group import NOTHING, Group
from ravestate.engine.loops import MANY, TURNS
from ravestate.engine.slots import Slots
from ravestate.engine.standing import Standing
from ravestate.engine.watch import Watch
from ravestate.errors import RuleError
from ravestate.policy.model import Clause, RulePlan, SlotPlan
from ravestate.policy.policy import Policy

ASKABLE = (READY, WAITING)

BATCH = 100
"""The number of activations without consent that start before the events of their runs are received."""


class Agenda(Slots):
    """The layer of the engine that decides which ready activations start."""

    __slots__ = (
        "_activity",
        "_breakers",
        "_pressure",
        "_queue",
        "patience",
        "ran",
        "standing",
    )

    def __init__(self, policy: Policy, patience: float) -> None:
        super().__init__(policy)
        self.patience = patience
        # The activations that ask in this instant, the best first.
        self._queue: list[tuple[int, float, int, int, Activation]] = []
        # The activations that wait for nothing but each other, the best first.
        self._breakers: list[tuple[tuple[float, int, int], Activation]] = []
        self.ran: dict[int, float] = {}
        """Number of a rule with a cooldown → the time of its last run (seconds)."""
        self.standing = Standing(self.ran)
        self._activity = policy.slot_of["core:activity"]
        self._pressure = policy.slot_of["core:pressure"]

    def look(self) -> None:
        """Make all alternatives visible to an observer: each becomes an activation that waits for the best clause."""
        for half, spikes in list(self.halves.items()):
            for first in list(spikes):
                self.unfold_half(first, half)
        for best in list(self.alternatives):
            spike = best.spikes[0]
            assert spike is not None  # the activation is ready, or runs
            self.unfold(best)
            for other in list(spike.holders) if best.state >= WAITING else ():
                if other.state is READY and other.clause.rule.slotset == best.clause.rule.slotset:
                    self._asking.pop(other, None)
                    self._refuse(other, Refusal.by(best, other))

    def effective(self, clause: Clause) -> float:
        """Return the effective utility of a clause now (L9): utility x weight x recovery, in nats."""
        self.standing.now = self.now
        return self.standing.effective(clause)

    def order(self, activation: Activation) -> tuple[float, int, int]:
        """Return the sort key of a ready activation: greatest effective utility, then first declared, then oldest."""
        return (-self.effective(activation.clause), activation.clause.index, activation.id)

    def _start_free(self) -> None:
        """Start ready activations that need no consent, in the order of their newest spikes, unless a guard is false."""
        started = 0
        while started < BATCH and (activation := self._free.pop()) is not None:
            if activation.clause.guards and not self._guarded(activation):
                continue
            if self._loops.runs > MANY and self._loops.defer(activation):
                continue
            self._start(activation)
            started += 1

    def _guarded(self, activation: Activation) -> bool:
        """Return whether the activation's predicates on slots are true; if not, the activation is no longer ready."""
        clause = activation.clause
        if not all(self.holds(s, g, clause.rule) for s, g in clause.guards):
            self._unready(activation)
            self._update(activation)
            return False
        return True

    def _consent_round(self) -> None:
        """Let ready activations ask for consent: older causes first, and the best activation first within a cause.

        If a rule has just started, an activation that reads one of its slots asks in the next round instead. So the
        activation sees the values that this rule writes before it suspends.
        """
        queue = self._queue
        self.standing.now = self.now
        asking = self._asking
        self._asking = {}
        if self._dirty or self._stirred:
            for group in self._dirty:
                asking.update(group.interested)
            self._dirty.clear()
            for hope in self._stirred:
                asking.update(self.hoping.get(hope, {}))
            self._stirred.clear()
        if queue:  # the places of those left may have changed since the last round
            asking.update((entry[4], None) for entry in queue if entry[4].state in ASKABLE)
            queue.clear()
        if len(asking) == 1:
            queue += [(0, 0.0, 0, 0, activation) for activation in asking]
        else:
            queue += [(*self._turn(activation), activation) for activation in asking]
            heapq.heapify(queue)
        written: set[int] = set()
        later: list[tuple[int, float, int, int, Activation]] = []
        while queue:
            entry = heapq.heappop(queue)
            activation = entry[4]
            clause = activation.clause
            if activation.state not in ASKABLE or (clause.guards and not self._guarded(activation)):
                continue
            if self._loops.runs > MANY and activation.state is READY and self._loops.defer(activation):
                continue
            rule = clause.rule
            if written and not rule.readable.isdisjoint(written):
                if self._is_taken(activation):
                    later.append(entry)  # by the next round it waits, or has lost its spike
                elif self._ask(activation, start=False):
                    later.append(entry)
                    break
            elif self._ask(activation):
                written.update(rule.slots)
        for entry in later:
            heapq.heappush(queue, entry)
        idle = not (
            queue or self._asking or self._dirty or self._stirred or self._acts or self._free.new or self._free.line
        )
        if idle and (self._refused or self._stuck):
            self._break_stalemate()

    def _break_stalemate(self) -> None:
        """Start the best of the activations that wait for nothing but each other, if there are any."""
        found = stalemate(self, self._refused, self._stuck)
        self._refused.clear()
        for activation in found:
            if activation not in self._stuck:
                self._stuck[activation] = None
                heapq.heappush(self._breakers, (self.order(activation), activation))
        while self._breakers:
            order, best = heapq.heappop(self._breakers)
            if best not in self._stuck:
                continue  # it has asked again since
            if order != self.order(best):
                heapq.heappush(self._breakers, (self.order(best), best))  # its rule has run meanwhile
                continue
            for group in best.firm_groups():
                for other in group.interested:  # what these wait for depends on the group, and so on this start
                    self._stuck.pop(other, None)
                    self._refused[other] = None
            self._start(best)
            break

    def _is_taken(self, activation: Activation) -> bool:
        """Return whether one of the activation's slots is taken in each of its groups."""
        slots = activation.clause.rule.slotset
        return all(not group.taken.keys().isdisjoint(slots) for group in activation.firm_groups())

    def _turn(self, activation: Activation) -> tuple[int, float, int, int]:
        """Return the activation's sort key in the queue: older causes first, and the best first within a cause."""
        groups = activation.firm_groups()
        cause = groups[0].id if len(groups) == 1 else min(group.id for group in groups)
        return (cause, *self.order(activation))

    def _ask(self, activation: Activation, *, start: bool = True) -> bool:
        """Return whether an activation has consent. With consent it starts, unless `start` is false; else it waits."""
        refusal = ask(self, activation)
        if not refusal:
            if start:
                self._start(activation)
            return True
        self._refuse(activation, refusal)
        activation.recheck = refusal.recheck
        if refusal.recheck != NEVER:
            self._deadlines.add(refusal.recheck, RECHECK, activation)
        return False

    def _refuse(self, activation: Activation, refusal: Refusal) -> None:
        """Make an activation wait, for the reasons in `refusal`."""
        activation.step(REFUSE)
        self._lose_interest(activation)
        self.waiting[activation] = self._refused[activation] = None
        names = tuple(refusal.names)
        changed = activation.waits_for != names
        activation.waits_for = names
        activation.blockers = tuple(refusal.blockers)
        activation.firm = tuple(refusal.firm)
        activation.bounded = refusal.pressed or refusal.taken
        activation.hopes = tuple(refusal.hopes)
        for hope, most in refusal.hopes.items():
            self.hoping.setdefault(hope, {})[activation] = None
            self._hope_counts[hope] = max(most, self._hope_counts.get(hope, 0))
        activation.interests = tuple(refusal.interests)
        for group in activation.interests:
            group.concern(activation)
        if changed and self.tracer is not None:
            until = None if activation.blockers else self.patience_of_rivals(activation)
            self.tracer(trace.Waits(self.now, activation.id, activation.clause.rule.name, names, until))

    def patience_of_rivals(self, activation: Activation) -> float | None:
        """Return when the patience of all pressured rivals of a waiting activation has ended (seconds), or None."""
        names = activation.waits_for
        times: list[float] = []
        for group in activation.firm_groups():
            times += [m.pressed[group] for m in group.members if m.clause.rule.name in names and group in m.pressed]
            clauses = self.policy.clause_plans
            times += [t for c, t in (group.pressed or {}).items() if clauses[c].rule.name in names and t > self.now]
        return max(times, default=None)

    def press(
        self, rival: Clause, member: Activation | None, group: Group, by: Activation, *, commit: bool = True
    ) -> float:
        """Return when a rival's patience in a group ends (seconds), for it may never be ready and `by` waits for it.

        The first time puts the rival under pressure (L16), if `commit`. `member` is the rival's activation, or None if
        the clause stands by.
        """
        table: dict[Any, float]
        key: Any
        if member is None:
            if group.pressed is None:
                group.pressed = {}
            table, key = group.pressed, rival.index
        else:
            if not member.pressed:
                member.pressed = {}
            table, key = member.pressed, group
        if key in table or not commit:
            return table.get(key, -NEVER)
        until = table[key] = self.now + (self.patience if rival.rule.patience is None else rival.rule.patience)
        if until > self.now:
            self._deadlines.add(until, PATIENCE, (group, rival.index if member is None else member))
        if self.tracer is not None:
            missing = rival.all_bits if member is None else member.missing
            lacks = tuple(n.signal.name for n in rival.needs if n.bit & missing)
            self.tracer(trace.Pressed(self.now, rival.rule.name, by.clause.rule.name, lacks, until))
        return until

    def is_pressed(self, time: float, owner: tuple[Group, int | Activation]) -> bool:
        """Return whether the patience of a rival still matters."""
        group, rival = owner[0].root(), owner[1]
        if isinstance(rival, int):
            return bool(group.interested)
        return rival.state < RUNNING and rival.pressed.get(group) == time

    def on_patience(self, time: float, owner: tuple[Group, int | Activation]) -> None:
        """Let the activations that wait in a group judge a rival again, whose patience is over (L16)."""
        self._dirty[owner[0].root()] = None

    def on_recheck(self, time: float, activation: Activation) -> None:
        """Let an activation ask again, because the order of recovering utilities has changed (L15)."""
        activation.recheck = NEVER
        if activation.state == WAITING:
            self._asking[activation] = None

    def on_timeout(self, time: float, run: Activation) -> None:
        """Cancel a run that has had its time (L18)."""
        self._cancel(run, "timeout")

    def eliminate(self, rival: Activation) -> None:
        """Make a rival whose patience is over give its spikes up for good (L16)."""
        for spike in rival.firm_spikes():
            self._refuse_for_good(spike, rival.clause.rule)
        self._end(rival, "eliminated")

    def _start(self, activation: Activation) -> None:
        """Start an activation: it takes its slots in its groups, and its function runs (L17)."""
        clause = activation.clause
        rule = clause.rule
        activation.step(GRANT)
        if activation.interests:
            self._lose_interest(activation)
        activation.recheck = NEVER
        if activation.pressed:
            activation.pressed = NOTHING
        activation.blockers = activation.waits_for = activation.firm = ()
        stands_on = activation.stands_on = activation.firm_spikes()
        if rule.slots:
            activation.groups = tuple(activation.firm_groups())
            for group in activation.groups:
                for slot in rule.slots:
                    group.take(slot, (activation,))
        elif len(clause.needs) > 1 or len(rule.clauses) > 1:
            self._give_up(activation, stands_on, "consumed")  # L10
        self.running[activation.id] = activation
        loops = self._loops
        loops.runs += 1
        if loops.runs > MANY and (loop := loops.trace(activation)):
            self._fail(loop[0], RuleError(_endless(loop)), signal=True)
        if rule.timeout is not None:
            activation.deadline = self.now + rule.timeout
            self._deadlines.add(activation.deadline, TIMEOUT, activation)
        for until in rule.until:
            self._watches.setdefault(until, {})[activation] = Watch(activation, until)
        payloads = {spike.signal.name: spike.payload for spike in activation.spikes if spike is not None}
        values: dict[str, Any] = {}
        for slot in rule.readable:
            values[self.policy.slot_plans[slot].name] = self.read(slot)
        if self.tracer is not None:
            ids = tuple(spike.id for spike in activation.spikes if spike is not None)
            self.tracer(trace.Started(self.now, activation.id, rule.name, clause.number, ids))
        self._acts = True
        self._out.append(Run(activation.id, rule.rule, payloads, values))

    def _set_flag(self, flag: SlotPlan, value: bool) -> None:
        """Change a built-in flag, and raise its signals only if a rule, the tracer or the runtime may hear them."""
        heard = flag.heard or self.tracer is not None or (self.watched and self._watched(flag))
        if heard or flag.index in self.policy.guarded:
            self._change(flag, value, (), None)
        else:
            self.values[flag.index] = value

    def _settle_flags(self) -> bool:
        """Update ``core:activity`` and ``core:pressure`` (L22); return whether one has changed."""
        kept = self.alternatives or self.waiting
        pressure = bool(kept) and any(not a.clause.reflexive for a in (*self.alternatives, *self.waiting))
        if pressure != self.values.get(self._pressure.index, False):
            self._set_flag(self._pressure, pressure)
            return True
        activity = self._busy > 0
        if activity != self.values.get(self._activity.index, False):
            self._set_flag(self._activity, activity)
            return True
        return False


def _endless(rules: Sequence[RulePlan]) -> str:
    """Return the error message about an endless loop of `rules`."""
    names = ", ".join(rule.name for rule in rules)
    whom = "each other" if len(rules) > 1 else "itself"
    return (
        f"an endless loop: {names} set {whom} off {MANY + TURNS:,} times within one instant; write "
        ".min_age(seconds) behind a signal of the loop, so that time passes"
    )
