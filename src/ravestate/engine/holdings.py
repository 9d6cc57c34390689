"""Holdings: which activation holds which live spike, and what follows when that changes (L12, L14, L20, L23).

Everything is indexed by what it concerns: live spikes by signal, activations by rule, and those that lack
something by the need that they lack. So an event costs by what it concerns, never by how many rules there are.
"""

from __future__ import annotations

import copy
from collections.abc import Iterable
from types import MappingProxyType
from typing import Any

from ravestate.declare.condition import Holds
from ravestate.declare.core import RuleFailure
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
from ravestate.engine.deadlines import (
    EXPIRE,
    FORGET,
    PATIENCE,
    RECHECK,
    RIPEN,
    STANDBY,
    TIMEOUT,
    WATCH,
    Deadlines,
    Entry,
)
from ravestate.engine.effects import Effect, Failed
from ravestate.engine.group import Group
from ravestate.engine.loops import MANY, Lineage, Loops
from ravestate.engine.spike import Spike
from ravestate.engine.trace import Tracer
from ravestate.engine.watch import Watch
from ravestate.policy.model import Clause, Need, RulePlan, SignalPlan, SlotPlan
from ravestate.policy.policy import Policy

__all__ = ["Holdings"]

PASSIVE = (int, float, str, bytes, bool, type(None), MappingProxyType)
"""Types of which a context needs no copy of its own."""


class Holdings:
    """Live spikes, and the activations that hold them."""

    def __init__(self, policy: Policy) -> None:
        self.policy = policy
        self.now = 0.0
        self.tracer: Tracer | None = None
        self.values: dict[int, Any] = {}
        """Slots that were written or read: index to value."""
        self._unseen: dict[int, dict[str, Any]] = {}
        """Of collections that were changed and that nobody has read since: what can be changed further without a copy."""
        self.live: dict[int, dict[Spike, None]] = {}
        """Live spikes by signal, oldest first."""
        self.active: dict[int, dict[Activation, None]] = {}
        """Activations that hold a spike or run, by rule."""
        self.lacking: dict[Need, dict[Activation, None]] = {}
        """Activations that hold something, but nothing for this need."""
        self.gated: dict[Activation, None] = {}
        """Activations that hold everything, but a predicate on a slot is false."""
        self.waiting: dict[Activation, None] = {}
        """Ready activations that were refused consent."""
        self.benches: dict[Activation, tuple[tuple[Clause, ...], int, int]] = {}
        """Activations that stand for others besides themselves (``contests.py``): the contest, how many of it are made,
        and the number before its first."""
        self.hoping: dict[Activation, None] = {}
        """Those of them that wait for what a live rule of another causal group might bring."""
        self.running: dict[int, Activation] = {}
        """Activations whose function runs, by the number of the run."""
        self.retired: set[int] = set()
        self.dropped: dict[str, int] = {}
        """How many spikes overflowed, by signal (L23)."""
        self.watched: dict[str, int] = {}
        """Signals whose spikes are reported."""
        self._out: list[Effect] = []
        self._acts = False  # whether there is something to do among it
        self._free: list[Activation] = []  # ready, and in need of nobody's consent
        self._asking: dict[Activation, None] = {}  # ready, and to be asked for consent
        self._refused: dict[Activation, None] = {}  # told to wait since the last look for a stalemate
        self._dirty: dict[Group, None] = {}  # groups in which something ended
        self._stirred = False  # something ended that those who wait on patience may have waited for
        self._watches: dict[Clause, dict[Activation, Watch]] = {}
        self._watched_by: dict[
            Spike, dict[Watch, None]
        ] = {}  # spikes that watches keep, until they are old enough
        # Failures that ``core:error`` has yet to signal, each with the rules that led to it.
        self._errors: list[tuple[RuleFailure, Lineage | None]] = []
        self._loops = Loops()
        self._blamed: set[int] = set()  # predicates whose failure has been reported
        self._deadlines = Deadlines(self._stands)
        self._busy = 0  # activations of rules that are not in the background
        self._activations: int = 0  # numbers given so far
        self._spikes = 0
        self._groups = 0

    def _new_activation(self, clause: Clause, number: int) -> Activation:
        """A stand-by activation takes its first spike: now there is one."""
        activation = Activation(number, clause)
        rule = clause.rule
        active = self.active.get(rule.index)
        if active is None:
            active = self.active[rule.index] = {}
        active[activation] = None
        if not (rule.background or clause.reflexive):
            self._busy += 1
        return activation

    def _stands(self, entry: Entry) -> bool:
        """Whether a deadline still counts."""
        time, kind, _, owner = entry
        if kind is EXPIRE:
            return bool(owner.holders) or owner in self.live.get(owner.signal.index, ())
        if kind is RIPEN:
            return owner.ripens == time
        if kind is PATIENCE:
            return owner.pressed == time
        if kind is STANDBY:
            group, clause, until = owner
            pressed = group.root().pressed
            return pressed is not None and pressed.get(clause) == until
        if kind is RECHECK:
            return owner.recheck == time
        if kind is TIMEOUT:
            return owner.deadline == time
        if kind is WATCH:
            return owner.due == time and owner.run.state == RUNNING
        return owner in self.live.get(owner.signal.index, ())

    def read(self, slot: int) -> Any:
        """The value of a slot, by its number."""
        if self._unseen:
            self._unseen.pop(slot, None)
        try:
            return self.values[slot]
        except KeyError:
            default: Any = self.policy.slot_plans[slot].slot.default
            if not isinstance(default, PASSIVE):
                default = copy.deepcopy(default)  # contexts share no state
            self.values[slot] = default
            return self.values[slot]

    def live_spike(self, need: Need) -> Spike | None:
        """A live spike, not given up by the rule and not consumed for it, that could meet a need."""
        return next(
            (spike for spike in self.live.get(need.signal.index, ()) if self._fits(need, spike)), None
        )

    def _fits(self, need: Need, spike: Spike) -> bool:
        rule = need.clause.rule
        if spike.born + need.max_age <= self.now and need.max_age:
            return False
        if not need.detached:
            if spike.refused is not None and rule.index in spike.refused:
                return False
            if spike.claims is not None and rule.index in spike.claims:
                return False
            if spike.group.root().finished(rule.slots):
                return False
            if need.clause.cyclic and spike.descends_from(rule.index):
                return False
        return all(self._test(predicate, spike.payload, rule) for predicate in need.predicates)

    def holds(self, slot: SlotPlan, guard: Holds, rule: RulePlan) -> bool:
        """Whether a predicate on a slot's present value is true; one that fails is false, and is reported."""
        return self._test(guard.predicate, self.read(slot.index), rule)

    def opens(self, slot: SlotPlan, guard: Holds) -> bool:
        """As `holds`, for who only looks: a predicate that fails is reported to nobody."""
        try:
            return bool(guard.predicate(self.read(slot.index)))
        except Exception:  # foreign code, as in `_test`
            return False

    def _test(self, predicate: Any, value: Any, rule: RulePlan) -> bool:
        try:
            return bool(predicate(value))
        except Exception as exception:  # a predicate is the designer's code: it may fail in any way
            if id(predicate) not in self._blamed:
                self._blamed.add(id(predicate))
                self._fail(rule, exception, signal=True)
            return False

    def _fail(
        self, rule: RulePlan, exception: BaseException, *, signal: bool, lineage: Lineage | None = None
    ) -> None:
        """Have a rule's failure logged and, if it is to `signal`, raise ``core:error`` next."""
        self._out.append(Failed(rule.name, exception))
        if signal:
            self._errors.append((RuleFailure(rule.name, exception), lineage))

    def _look(self, activation: Activation) -> None:
        """Let an activation look at what is there already: detached needs take what is live, the newest that is old
        enough; and the same spike may meet two constraints of one clause."""
        for need in activation.clause.needs:
            if not need.bit & activation.missing:
                continue
            live = self.live.get(need.signal.index)
            if not live:
                continue
            if need.detached:
                best: Spike | None = None
                for spike in reversed(live):
                    if self._fits(need, spike):
                        best = spike  # too young ones: the oldest of them ripens first
                        if spike.born + need.min_age <= self.now:
                            break
                if best is not None:
                    self._acquire(activation, need, best)

    def _rematch(self, activation: Activation, need: Need) -> None:
        """An activation has lost a spike: let it take another that is live, the oldest first (L16 i)."""
        if need.detached:
            self._look(activation)
        else:
            for spike in self.live.get(need.signal.index, ()):
                if self._fits(need, spike) and self._coherent(activation, need, spike):
                    self._acquire(activation, need, spike)
                    return

    def _coherent(self, activation: Activation, need: Need, spike: Spike) -> bool:
        """Whether a spike is of the causal group in which the need's kin are met (L12)."""
        if need.kin == need.bit:
            return True
        held = activation.held(need.kin & ~need.bit)
        return held is None or held.group.root() is spike.group.root()

    def _acquire(self, activation: Activation, need: Need, spike: Spike) -> None:
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
        """A rule that hears the signal does not take the spike; this is only told."""
        if self.tracer is not None:
            rule = clause.rule
            by, run = spike.group.root().answer(rule.slots) if reason == "consumed" else ("", 0)
            self.tracer(
                trace.Passed(self.now, rule.name, clause.number, spike.id, spike.signal.name, reason, by, run)
            )

    def _update(self, activation: Activation) -> None:
        """Its spikes have changed, or become old enough: it may be ready (L14), or wait for an age."""
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

    def _let_expire(self, spike: Spike, due: float) -> None:
        """Holders that are still incomplete at a time (seconds) give the spike up then (L14)."""
        if due <= self.now or due not in spike.expiring:
            spike.expiring = (*spike.expiring, due)
            self._deadlines.add(due, EXPIRE, spike)

    def _expire(self, spike: Spike, time: float) -> None:
        for holder in list(spike.holders):
            if holder.state is GATHERING:
                old = [need for need in self._of_spike(holder, spike) if spike.born + need.max_age <= time]
                self._lose(holder, old, "age")

    def _complete(self, activation: Activation) -> None:
        """It is ready: a writer asks for consent, others just start."""
        activation.step(COMPLETE)
        if self._loops.runs <= MANY or not self._loops.defer(activation):
            self._enqueue(activation)

    def _enqueue(self, activation: Activation) -> None:
        clause = activation.clause
        if clause.rule.slots and clause.firm_bits:
            self._asking[activation] = None
        else:
            self._free.append(activation)

    def _release(self, activation: Activation, need: Need, reason: str, by: Activation | None = None) -> None:
        """Take a spike from an activation, perhaps because of a run."""
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
        if all(other is not spike for other in activation.spikes):
            spike.holders.pop(activation, None)
            if not spike.holders:
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

    def _lose(
        self, activation: Activation, needs: Iterable[Need], reason: str, by: Activation | None = None
    ) -> None:
        """An activation gives spikes up; without any left it is no more."""
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
        # A lost spike may have kept out spikes of other groups: its kin may now find theirs, too.
        for need in (*needs, *(n for n in clause.needs if n.bit & kin)):
            if need.bit & activation.missing:
                self._rematch(activation, need)
        self._update(activation)

    def _stir(self, activation: Activation) -> None:
        """What it holds has changed: whoever waits for it may wait for it no longer."""
        for group in activation.firm_groups():
            if group.interested:
                self._dirty[group] = None

    def _unready(self, activation: Activation) -> None:
        activation.step(LOSE)
        activation.ripens = NEVER
        if activation.interests:
            self._lose_interest(activation)
        self._asking.pop(activation, None)
        self.gated.pop(activation, None)

    def _end(self, activation: Activation, reason: str = "", by: Activation | None = None) -> None:
        """An activation is no more: nothing of it is left. With a reason, what it held counts as given up."""
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
            activation.blockers = ()
        else:
            activation.deadline = NEVER
            activation.stands_on = activation.groups = ()
        if activation.pressed != NEVER:
            activation.pressed = NEVER
        self.benches.pop(activation, None)
        active = self.active[clause.rule.index]
        del active[activation]
        if not active:
            del self.active[clause.rule.index]
        self._stirred = bool(self.hoping)
        if not (clause.rule.background or clause.reflexive):
            self._busy -= 1

    def _lose_interest(self, activation: Activation) -> None:
        """It waits no longer: what happens in those groups does not concern it."""
        self.waiting.pop(activation, None)
        self._refused.pop(activation, None)
        self.hoping.pop(activation, None)
        for group in activation.interests:
            group.root().forget(activation)
        activation.interests = ()

    def _forget(self, spike: Spike) -> None:
        """Nobody holds the spike: it is gone, unless detached needs may still look at it."""
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

    def _kill(self, spike: Spike, reason: str) -> None:
        """Withdraw a spike: activations give it up (L20); a run that stands on it keeps what it has."""
        if self.tracer is not None:
            self.tracer(trace.Dropped(self.now, spike.id, spike.signal.name, reason))
        live = self.live.get(spike.signal.index)
        if live is not None:
            live.pop(spike, None)
            if not live:
                del self.live[spike.signal.index]
        for watch in self._watched_by.pop(spike, ()):
            watch.lose(spike)
        for holder in list(spike.holders):
            if holder.state < RUNNING:
                self._lose(holder, self._of_spike(holder, spike), "withdrawn")
            else:
                self.benches.pop(holder, None)  # who sits there would have given it up

    def _withdraw(self, signal: SignalPlan, reason: str) -> None:
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
