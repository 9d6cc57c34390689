"""A naive interpreter of the laws, with which ``properties/fuzz.py`` compares the engine.

The interpreter keeps lists, has no index, and decides everything again at every moment. It shares the records of the
policy (utilities, coherence), the events and the effects with the engine, but no other code. It leaves out the law
about a thousand runs in one instant (L23, fairness), because the compared plays have fewer runs.

In the code, an *act* is an activation, and a *need* is a constraint of a clause.
"""

from __future__ import annotations

from collections.abc import Iterable
from math import inf, isclose
from types import MappingProxyType
from typing import Any

from laws.model_horizon import PERHAPS, SURE, Derivation
from laws.model_records import CANCELLED, ENDED, GATHERS, READY, RUNS, Act, Group, Spike
from ravestate.declare.core import RuleFailure
from ravestate.declare.slot import Entry
from ravestate.engine import events
from ravestate.engine.effects import Cancel, Effect, Ended, Failed, Run
from ravestate.errors import RuleError, RuleTimeout

INSTANT = 0.5e-9
"""Two times that differ by no more than this count as one moment (seconds)."""

BATCH = 100
"""The number of rules that may start without consent before the events of their runs arrive."""


class Model:
    """The interpreter. It has the four methods of an engine."""

    def __init__(self, policy: Any, *, patience: float = 1.0, report_ends: bool = True) -> None:
        self.policy = policy
        self.patience = patience
        self.now = 0.0
        self.values: dict[int, Any] = {}
        self.spikes: list[Spike] = []
        self.writing = False  # whether the signals of a write are being raised
        self.newborn: Spike | None = None  # a spike that has not been offered to all rules yet
        self.acts: list[Act] = []
        self.running: dict[int, Act] = {}
        self.retired: set[int] = set()
        self.ran: dict[int, float] = {}
        self.failures: list[RuleFailure] = []
        self.faults: list[tuple[int, str, Any, Exception]] = []  # the predicates that have raised an exception
        self.blamed: set[int] = set()
        self.chains: dict[tuple[Any, bool], set[int]] = {}
        self.out: list[Effect] = []
        self.born = self.steps = self.count = self.groups = self.runs = 0

    # ------------------------------------------------------------------------------- time

    def receive(self, event: Any, now: float) -> None:
        assert now == self.now, "call `advance` up to this time first"
        getattr(self, f"on_{type(event).__name__.lower()}")(event)
        self.settle()

    def advance(self, now: float) -> None:
        while (due := self.next_deadline()) is not None and due <= now:
            self.now = due
            self.tick()
        self.now = max(self.now, now)

    def next_deadline(self) -> float | None:
        """Return the next time at which something can change without an event."""
        times: list[float] = []
        for act in self.acts:
            if act.state in (GATHERS, READY):
                for need in act.clause.needs:
                    for spike in self.spikes if need.detached else filter(None, [act.held.get(need.index)]):
                        times += [spike.born + need.min_age, spike.born + need.max_age]
                times += act.pressed.values()
                times += [group.pressed[c] for group in act.groups() for c in group.pressed]
            for clause in act.rule.until if act.state == RUNS else ():
                held = act.watch.get(clause.index, {})
                times += [spike.born + clause.needs[n].min_age for n, spike in held.items()]
            times.append(act.due)
        for spike in self.spikes:  # a rival in stand-by can look at it until it is too old
            times += [spike.born + need.max_age for need in spike.signal.listeners if need.detached]
        if any(act.state == READY for act in self.acts):
            plans = [rule for rule in self.policy.rule_plans if rule.cooldown]
            times += [self.ran[r.index] + r.cooldown for r in plans if r.index in self.ran]
            for mine in (c for r in self.policy.rule_plans for c in r.clauses):
                for theirs in (c for r in plans for c in r.clauses):
                    times += [self.crossing(mine, theirs), self.crossing(theirs, mine)]
        return min((time for time in times if self.now < time < inf), default=None)

    def tick(self) -> None:
        """Do everything that is due at this moment; gains come before losses."""
        self.settle()
        for act in list(self.acts):
            if act.state == GATHERS:
                old = [n for n in act.clause.needs if n.index in act.held and self.old(n, act.held[n.index])]
                self.lose(act, old)
        self.settle()
        for act in list(self.running.values()):
            if act.state == RUNS and act.due <= self.now:
                self.cancel(act, "timeout")
        self.watch_all()

    def old(self, need: Any, spike: Spike) -> bool:
        return spike.born + need.max_age <= self.now

    def settle(self) -> None:
        """Offer spikes to detached constraints, drop spikes that no activation can hold any more, and find the ready
        activations."""
        for act in list(self.acts):
            if act.clause.asks_detached and act.state in (GATHERS, READY):
                for need in act.clause.needs:
                    if need.detached:
                        self.look(act, need)
        held = {self.newborn, *(spike for act in self.acts for spike in act.held.values())}
        self.spikes = [
            s for s in self.spikes if s in held or (s.signal.retain >= 0 and s.born + s.signal.retain > self.now)
        ]
        for act in list(self.acts):
            if act.state == GATHERS and not act.lacks() and self.ripe(act):
                if act.gated and self.writing:
                    continue  # check the gates again after the signals of a write
                act.gated = not self.opens(act.clause)
                if not act.gated:
                    act.state = READY
            else:
                act.gated = False

    def ripe(self, act: Act) -> bool:
        return all(act.held[n.index].born + n.min_age <= self.now for n in act.clause.needs)

    def look(self, act: Act, need: Any) -> None:
        """Hold the newest live spike that fits and is old enough, or else the first to become old enough (L19)."""
        fits = [s for s in self.spikes if s.signal is need.signal and self.fits(need, s)]
        ripe = [s for s in fits if s.born + need.min_age <= self.now]
        if ripe:
            act.held[need.index] = ripe[-1]
        elif need.index not in act.held and fits:
            act.held[need.index] = fits[0]

    # ------------------------------------------------------------------------------- effects

    def effects(self) -> list[Effect]:
        while not any(isinstance(effect, (Run, Cancel)) for effect in self.out):
            self.tick()
            self.report()
            if any(isinstance(effect, Cancel) for effect in self.out):
                break
            if self.failures:
                failure = self.failures.pop(0)
                self.birth(self.policy.signal_of["core:error"], failure, (), self.new_group(), None)
                self.settle()
            elif self.busy() and not self.value(self.policy.slot_of["core:activity"]):
                self.flag("core:activity", True)
            elif not (self.start_free() or self.consent_round() or self.break_stalemate() or self.settle_flags()):
                break
        self.report()
        out, self.out = self.out, []
        return out

    def busy(self) -> bool:
        return any(not (act.rule.background or act.clause.reflexive) for act in self.acts)

    def settle_flags(self) -> bool:
        waits = any(act.state == READY and not act.clause.reflexive for act in self.acts)
        for name, value in (("core:pressure", waits), ("core:activity", self.busy())):
            if self.value(self.policy.slot_of[name]) != value:
                self.flag(name, value)
                return True
        return False

    def flag(self, name: str, value: bool) -> None:
        self.change(self.policy.slot_of[name], value, (), None)
        self.settle()

    def asks(self, act: Act) -> bool:
        return bool(act.rule.slots and act.clause.firm_bits)

    def guarded(self, act: Act) -> bool:
        if self.opens(act.clause):
            return True
        act.state = GATHERS
        return False

    def start_free(self) -> bool:
        found, started = False, 0
        while started < BATCH and (free := [act for act in self.acts if act.state == READY and not self.asks(act)]):
            found = True
            first = min(free, key=lambda act: (max(s.id for s in act.held.values()), act.clause.index, act.id))
            if self.guarded(first):
                self.start(first)
                started += 1
        return found

    def consent_round(self) -> bool:
        """Let the ready activations ask for consent (L15): older causes first, then greater utility. Ask again if a
        rival has given up (L16)."""
        changed, count = False, len(self.acts)
        written: set[int] = set()
        asking = sorted((a for a in self.acts if a.state == READY and self.asks(a)), key=self.order)
        for act in asking:
            if act.state != READY:
                continue
            if not self.guarded(act):
                changed = True
            elif written.isdisjoint(act.rule.readable):
                if self.consents(act):
                    self.start(act)
                    written |= act.rule.slotset
                    changed = True
            elif self.consents(act):
                break  # `act` reads a slot that a rule of this round may write, so it asks after this write
        return changed or len(self.acts) < count

    def order(self, act: Act) -> Any:
        return (min(g.id for g in act.groups()), -self.worth(act.clause), act.clause.index, act.id)

    # ------------------------------------------------------------------------------- utility

    def recovery(self, rule: Any) -> tuple[float, float]:
        """Return how far a rule has recovered, and how fast it does (per second)."""
        ran = self.ran.get(rule.index)
        if not rule.cooldown or ran is None or self.now - ran >= rule.cooldown - INSTANT:
            return 1.0, 0.0
        return (self.now - ran) / rule.cooldown, 1.0 / rule.cooldown

    def worth(self, clause: Any) -> float:
        return clause.base * self.recovery(clause.rule)[0]

    def refuses(self, theirs: Any, mine: Any) -> bool:
        return all(self.goes_before(theirs, mine))

    def goes_before(self, theirs: Any, mine: Any) -> tuple[bool, bool]:
        """Return whether clause `theirs` goes before clause `mine`: now, and in the next moment (L15)."""
        (far, fast), (my_far, my_fast) = self.recovery(theirs.rule), self.recovery(mine.rule)
        weight, my_weight = theirs.rule.weight, mine.rule.weight
        utility, my_utility = theirs.utility * weight, mine.utility * my_weight
        now = [(utility * far, my_utility * my_far), (weight * far, my_weight * my_far)]
        soon = [
            now[0],
            (utility * fast, my_utility * my_fast),
            now[1],
            (weight * fast, my_weight * my_fast),
        ]
        return self.leads(now, theirs, mine), self.leads(soon, theirs, mine)

    def leads(self, pairs: list[tuple[float, float]], theirs: Any, mine: Any) -> bool:
        """Return whether `theirs` has the greater number in the first pair that differs; if none differs, go by order.

        The second half of `pairs` counts only if the first half consists of zeros.
        """
        for place, (one, other) in enumerate(pairs):
            if place == len(pairs) // 2 and any(pair != (0.0, 0.0) for pair in pairs[:place]):
                break
            if not isclose(one, other, rel_tol=1e-9):
                return one > other
        return theirs.index < mine.index

    def crossing(self, mine: Any, theirs: Any) -> float:
        """Return when clause `mine` overtakes clause `theirs`, if both continue to recover as now."""
        (far, fast), (their_far, their_fast) = self.recovery(mine.rule), self.recovery(theirs.rule)
        closing = mine.base * fast - theirs.base * their_fast
        if closing <= 0 or theirs.base * their_far <= mine.base * far:
            return inf
        # The time is counted from the last run, so that it does not depend on the moment of this call.
        began = max(self.ran[c.rule.index] for c, speed in ((mine, fast), (theirs, their_fast)) if speed)
        far = (began - self.ran[mine.rule.index]) * fast if fast else far
        their_far = (began - self.ran[theirs.rule.index]) * their_fast if their_fast else their_far
        turn = began + (theirs.base * their_far - mine.base * far) / closing
        return round(turn, 9) if round(turn, 9) > self.now else turn  # so that equal moments are equal numbers

    # ------------------------------------------------------------------------------- consent

    def consents(self, act: Act) -> bool:
        return not self.refusals(act)

    def refusals(self, act: Act, without: Iterable[Act] = (), commit: bool = True) -> set[str]:
        """Return why groups refuse consent (L15).

        A slot is ``taken``, or a rival becomes ready, ``surely`` or ``perhaps``. With `commit`, a rival that perhaps
        becomes ready comes under pressure, or gives up (L16). Ignore the work of the activations in `without`.
        """
        reasons: set[str] = set()
        still = frozenset((act, *self.kept_by(act), *without))
        derivation = Derivation(self, still)
        soon: list[tuple[Any, Group]] = []
        ended = False
        for group in act.groups():
            if any(slot in group.taken for slot in act.rule.slots):
                reasons.add("taken")
                continue
            for rival in [c for r in self.policy.rule_plans for c in r.clauses]:
                if (
                    rival is act.clause
                    or rival.rule.index in self.retired
                    or rival.rule.slotset.isdisjoint(act.rule.slotset)
                ):
                    continue
                first, next_ = self.goes_before(rival, act.clause)
                if first and next_:
                    if self.judge_rival(rival, group, derivation, reasons, commit=commit):
                        derivation, ended = Derivation(self, still), True
                elif next_:
                    soon.append((rival, group))
        for rival, group in soon if reasons else ():  # `act` keeps waiting; these rivals are ahead from now on
            if self.judge_rival(rival, group, derivation, reasons, commit=commit):
                derivation, ended = Derivation(self, still), True
        if ended and reasons:
            return self.refusals(act, without)  # a reason may have depended on a rival that gave up
        return reasons

    def judge_rival(self, rival: Any, group: Group, derivation: Derivation, reasons: set[str], *, commit: bool) -> bool:
        """Add the reasons why a group refuses because of a rival; return whether an activation of the rival gave up."""
        sure: list[Act] = []
        ended = False
        for member in [*(a for a in self.acts if a.clause is rival and a.state < RUNS), None]:
            if member is not None:
                if member not in self.acts or member in derivation.still:
                    continue
                if any(set(member.firm()) <= set(older.firm()) for older in sure):
                    continue  # an older activation, which will run, holds all spikes of this one
            strength = derivation.rival(rival, member, group)
            if strength == SURE:
                reasons.add("surely")
                if member is not None:
                    sure.append(member)
            elif strength == PERHAPS:
                table: dict[Any, float] = group.pressed if member is None else member.pressed
                key: Any = rival.index if member is None else group
                patience = self.patience if rival.rule.patience is None else rival.rule.patience
                if commit:
                    table.setdefault(key, self.now + patience)
                if table.get(key, -inf) > self.now:
                    reasons.add("perhaps")
                elif commit and member is not None:
                    for spike in member.firm():
                        spike.refused.add(rival.rule.index)
                    self.end(member)
                    self.settle()
                    derivation, ended = Derivation(self, derivation.still), True
        return ended

    def kept_by(self, act: Act) -> list[Act]:
        """Return the activations that wait, or would wait, for this activation (L16)."""
        clause, slots, groups = act.clause, act.rule.slotset, set(act.groups())
        behind: dict[Any, bool] = {}  # compute this only once for all activations of a clause
        return [
            other
            for other in self.acts
            if other.state < RUNS
            and other.clause is not clause
            and not other.rule.slotset.isdisjoint(slots)
            and (
                behind[other.clause]
                if other.clause in behind
                else behind.setdefault(other.clause, self.goes_before(clause, other.clause)[1])
            )
            and not groups.isdisjoint(other.groups())
        ]

    def break_stalemate(self) -> bool:
        """If some activations wait only for each other, start the best of them."""
        asking = [act for act in self.acts if act.state == READY and self.asks(act)]
        stuck = [act for act in asking if self.refusals(act, commit=False) == {"surely"}]
        while stuck:
            freed = [act for act in stuck if self.refusals(act, without=stuck, commit=False)]
            if not freed:
                break
            stuck = [act for act in stuck if act not in freed]
        if stuck:
            self.start(min(stuck, key=lambda act: self.order(act)[1:]))
        return bool(stuck)

    def start(self, act: Act) -> None:
        """Start a run: it takes its slots in its groups (L17)."""
        rule = act.rule
        act.state = RUNS
        act.parents = act.firm()
        if rule.slots:
            act.took = act.groups()
            for group in act.took:
                for slot in rule.slots:
                    group.taken[slot] = [*(group.taken.get(slot) or ()), act]
        else:
            self.give_up(act, act.parents)  # L10: already when the run starts
        self.runs += 1
        act.number = self.runs
        self.running[act.number] = act
        if rule.timeout is not None:
            act.due = self.now + rule.timeout
        act.watch = {clause.index: {} for clause in rule.until}
        payloads = {need.signal.name: act.held[need.index].payload for need in act.clause.needs}
        plans = self.policy.slot_plans
        self.out.append(
            Run(act.number, rule.rule, payloads, {plans[s].name: self.value(plans[s]) for s in rule.readable})
        )

    # ------------------------------------------------------------------------------- spikes

    def new_group(self) -> Group:
        self.groups += 1
        return Group(self.groups)

    def origin(self, run: Act | None) -> tuple[tuple[Spike, ...], Group]:
        """Return the parents of a run's spikes, and their group; several groups merge (L11)."""
        parents = () if run is None or run.rule.detached else run.parents
        if not parents:
            return (), self.new_group()
        for parent in parents[1:]:
            self.merge(parents[0].group.root(), parent.group.root())
        return parents, parents[0].group.root()

    def merge(self, one: Group, other: Group) -> None:
        if one is other:
            return
        root, merged = (one, other) if one.id < other.id else (other, one)
        merged.into = root
        for slot, runs in merged.taken.items():
            mine = root.taken.get(slot, [])
            root.taken[slot] = None if runs is None or mine is None else mine + runs
        for clause, due in merged.pressed.items():
            root.pressed[clause] = min(due, root.pressed.get(clause, inf))
        for act in self.acts:
            if merged in act.pressed:
                act.pressed[root] = min(act.pressed.pop(merged), act.pressed.get(root, inf))
        consumed = {slot for slot, runs in root.taken.items() if runs is None}
        for act in list(self.acts):
            if act.state < RUNS and not act.rule.slotset.isdisjoint(consumed):
                self.lose(act, self.of_group(act, root))
        offers = [
            (spike.id, act.id, need.index, spike, act, need)
            for act in self.acts
            if act.state == GATHERS and root in act.groups()
            for need in act.lacks()
            if need.kin != need.bit and not need.detached
            for spike in self.spikes
            if spike.signal is need.signal and spike.group.root() is root and act.id <= spike.newest
        ]
        for _, _, _, spike, act, need in sorted(offers, key=lambda offer: offer[:3]):
            if need.index not in act.held and self.coheres(act, need, spike) and self.fits(need, spike):
                act.held[need.index] = spike
                self.settle()

    def birth(self, signal: Any, payload: Any, parents: tuple[Spike, ...], group: Group, run: Act | None) -> None:
        if run is not None and run.told == "wiped" and parents:
            return
        self.born += 1
        rule = -1 if run is None or run.rule.detached else run.rule.index
        spike = Spike(self.born, signal, payload, self.now, group, parents, rule, self.count)
        self.spikes.append(spike)
        self.newborn = spike
        mine = [s for s in self.spikes if s.signal is signal]
        if len(mine) > signal.limit:
            self.withdraw(mine[0])
        for need in signal.watchers:
            for act in list(self.running.values()):
                if act.state == RUNS and need.clause in act.rule.until and self.passes(need, payload):
                    held = act.watch[need.clause.index]
                    before = held.get(need.index)
                    if before is None or not need.min_age or before.born + need.max_age < self.now:
                        held[need.index] = spike
                    self.judge(act, need.clause)
        for need in signal.listeners:
            self.offer(need, spike)
        self.newborn = None

    def passes(self, need: Any, payload: Any) -> bool:
        return all(self.test(predicate, payload, need.clause) for predicate in need.predicates)

    def test(self, predicate: Any, value: Any, clause: Any) -> bool:
        """Return the result of a predicate; a predicate that raises counts as false (L18)."""
        try:
            return bool(predicate(value))
        except Exception as exception:
            self.faults.append((clause.index, clause.rule.name, predicate, exception))
            return False

    def report(self) -> None:
        """Report each predicate that has raised an exception only once, in declaration order (L5)."""
        for _, rule, predicate, exception in sorted(self.faults, key=lambda fault: fault[0]):
            if id(predicate) not in self.blamed:
                self.blamed.add(id(predicate))
                self.out.append(Failed(rule, exception))
                self.failures.append(RuleFailure(rule, exception))
        self.faults.clear()

    def opens(self, clause: Any) -> bool:
        return all(self.test(guard.predicate, self.value(slot), clause) for slot, guard in clause.guards)

    def opens_quietly(self, slot: Any, guard: Any) -> bool:
        """Return whether a predicate on a slot is true, to decide whether a rival is viable (L16)."""
        try:
            return bool(guard.predicate(self.value(slot)))
        except Exception:
            return False

    def offer(self, need: Any, spike: Spike) -> None:
        """Offer a spike to every activation that lacks it, oldest first, and then to the stand-by activation (L12)."""
        clause, rule = need.clause, need.clause.rule
        if rule.index in self.retired or not self.fits(need, spike) or spike.withdrawn:
            return
        if need.detached and clause.asks_detached:
            return  # `settle` looks for spikes for this constraint
        for act in list(self.acts):
            able = act.clause is clause and act.state == GATHERS and need.index not in act.held
            if able and self.coheres(act, need, spike):
                act.held[need.index] = spike
        self.count += 1
        act = Act(self.count, clause, {need.index: spike})
        self.acts.append(act)
        if not need.detached and clause.index in spike.group.root().pressed:
            act.pressed[spike.group.root()] = spike.group.root().pressed[clause.index]
        self.settle()

    def fits(self, need: Any, spike: Spike) -> bool:
        rule = need.clause.rule
        if self.old(need, spike) and not (spike.born == self.now and not need.max_age):
            return False
        if not need.detached and (
            rule.index in spike.refused
            or spike.group.root().consumed(rule.slots)
            or any(one.rule == rule.index for one in spike.ancestry())
        ):
            return False
        return self.passes(need, spike.payload)

    def coheres(self, act: Act, need: Any, spike: Spike) -> bool:
        kin = [
            act.held[n.index] for n in act.clause.needs if n.bit & need.kin and n is not need and n.index in act.held
        ]
        return need.detached or all(other.group.root() is spike.group.root() for other in kin)

    def of_group(self, act: Act, group: Group) -> list[Any]:
        held = act.held.items()
        return [act.clause.needs[n] for n, s in held if not act.clause.needs[n].detached and s.group.root() is group]

    def lose(self, act: Act, needs: Iterable[Any]) -> None:
        """Give spikes up, and take the oldest spikes that fit instead (L12). Without any spike, end the activation."""
        needs = sorted((need for need in needs if need.index in act.held), key=lambda need: need.index)
        if not needs:
            return
        clause = act.clause
        left = [n for n in clause.needs if n.index in act.held and n not in needs]
        if not left or (clause.asks_detached and all(n.detached for n in left)):
            self.end(act)
            return
        for need in needs:
            del act.held[need.index]
        act.state = GATHERS
        kin = 0
        for need in needs:
            kin |= need.kin
        for need in (*needs, *(n for n in clause.needs if n.bit & kin and n not in needs)):
            if need.index in act.held:
                continue
            if need.detached:
                self.look(act, need)
                continue
            for spike in self.spikes:
                if spike.signal is need.signal and self.fits(need, spike) and self.coheres(act, need, spike):
                    act.held[need.index] = spike
                    break
        self.settle()

    def end(self, act: Act) -> None:
        act.state = ENDED
        self.acts.remove(act)

    def withdraw(self, spike: Spike) -> None:
        """Withdraw a spike (L20)."""
        spike.withdrawn = True
        if spike in self.spikes:
            self.spikes.remove(spike)
        for act in list(self.acts):
            for held in act.watch.values():
                for place in [n for n, s in held.items() if s is spike]:
                    del held[place]
            if act.state < RUNS:
                self.lose(act, [n for n in act.clause.needs if act.held.get(n.index) is spike])

    def supersede(self, signal: Any) -> None:
        for spike in [s for s in self.known() if s.signal is signal]:
            self.withdraw(spike)

    def known(self) -> list[Spike]:
        watched = [spike for act in self.acts for held in act.watch.values() for spike in held.values()]
        return sorted(dict.fromkeys([*self.spikes, *watched]), key=lambda spike: spike.id)

    def give_up(self, act: Act, spikes: tuple[Spike, ...]) -> None:
        """Make a rule give these spikes up, in all its activations (L18, L10)."""
        for spike in spikes:
            spike.refused.add(act.rule.index)
        for spike in spikes:
            for other in list(self.acts):
                if other is not act and other.rule is act.rule and other.state < RUNS:
                    needs = other.clause.needs
                    self.lose(other, [n for n in needs if other.held.get(n.index) is spike and not n.detached])

    # ------------------------------------------------------------------------------- until

    def watch_all(self) -> None:
        for act in list(self.running.values()):
            for clause in act.rule.until if act.state == RUNS else ():
                self.judge(act, clause)

    def judge(self, act: Act, clause: Any) -> None:
        """Interrupt a run whose `until` condition is met (L21)."""
        held = act.watch[clause.index]
        if act.state == RUNS and len(held) == len(clause.needs):
            ages = [(need, self.now - held[need.index].born) for need in clause.needs]
            young = any(held[need.index].born + need.min_age > self.now for need, _ in ages)
            old = any(held[need.index].born + need.max_age < self.now for need, _ in ages)
            if not young and not old and self.opens(clause):
                self.cancel(act, "interrupted")

    def cancel(self, act: Act, reason: Any) -> None:
        act.state = CANCELLED
        act.told = reason
        act.due = inf
        self.out.append(Cancel(act.number, reason))

    # ------------------------------------------------------------------------------- slots

    def value(self, slot: Any) -> Any:
        default = slot.slot.default
        return self.values.setdefault(slot.index, dict(default) if slot.is_collection else default)

    def change(self, slot: Any, value: Any, parents: tuple[Spike, ...], run: Act | None) -> None:
        """Set the value of a slot, and raise its signals (L2, L13)."""
        self.values[slot.index] = value
        group = self.origin(run)[1]
        if slot.keep_latest:
            for signal in slot.signals:
                self.supersede(signal)
        self.writing = True
        which = (0, 1 if value else 2) if slot.is_flag else (0,)
        for place in which:
            self.birth(slot.signals[place], value, parents, group, run)
        self.regate()

    def regate(self) -> None:
        self.writing = False
        self.settle()
        self.watch_all()

    def store(self, slot: Any, key: str, item: Any, run: Act | None, *, remove: bool = False) -> None:
        old = self.value(slot)
        if (key not in old) if remove else (key in old and old[key] == item):
            return
        items = {k: v for k, v in old.items() if k != key} if remove else {**old, key: item}
        changed, added, removed = slot.signals
        raised = (changed, removed) if remove else (changed,) if key in old else (changed, added)
        entry = Entry(key, old[key] if remove else item)
        self.values[slot.index] = MappingProxyType(items)
        parents, group = self.origin(run)
        self.writing = True
        for signal in raised:
            if signal.keep_latest:
                self.supersede(signal)
            self.birth(signal, entry, parents, group, run)
        self.regate()

    # ------------------------------------------------------------------------------- events

    def run_of(self, event: Any) -> Act | None:
        return None if event.run is None else self.running[event.run]

    def on_start(self, _: Any) -> None:
        self.birth(self.policy.signal_of["core:startup"], None, (), self.new_group(), None)

    def on_stop(self, _: Any) -> None:
        self.birth(self.policy.signal_of["core:shutdown"], None, (), self.new_group(), None)

    def on_write(self, event: Any) -> None:
        slot, run = self.policy.slot_of[event.slot], self.run_of(event)
        if run is not None:
            run.wrote = True
        if slot.is_collection:
            for key in [k for k in self.value(slot) if k not in event.value]:
                self.store(slot, key, None, run, remove=True)
            for key, item in event.value.items():
                self.store(slot, key, item, run)
            return
        value = bool(event.value) if slot.is_flag else event.value
        if slot.always or self.value(slot) != value:
            self.change(slot, value, self.origin(run)[0], run)

    def on_store(self, event: Any) -> None:
        run = self.run_of(event)
        if run is not None:
            run.wrote = True
        self.store(self.policy.slot_of[event.slot], event.key, event.item, run)

    def on_discard(self, event: Any) -> None:
        run = self.run_of(event)
        if run is not None:
            run.wrote = True
        self.store(self.policy.slot_of[event.slot], event.key, None, run, remove=True)

    def on_emit(self, event: Any) -> None:
        signal, run = self.policy.signal_of[event.signal], self.run_of(event)
        if signal.keep_latest:
            self.supersede(signal)
        parents, group = self.origin(run)
        self.birth(signal, event.payload, parents, group, run)

    def on_wipe(self, event: Any) -> None:
        wiper = self.run_of(event)
        doomed = [s for s in self.known() if any(one.signal.name == event.signal for one in s.ancestry())]
        for spike in doomed:
            for act in sorted(self.acts, key=lambda act: (act.clause.index, act.id)):
                if act.state == RUNS and act is not wiper and act.rule.interruptible and spike in act.held.values():
                    self.cancel(act, "wiped")
            self.withdraw(spike)

    def on_addrule(self, event: Any) -> None:
        known = len(self.policy.rule_plans)
        self.policy = event.policy
        self.chains.clear()
        clauses = self.policy.clause_plans
        for act in self.acts:
            act.clause = clauses[act.clause.index]
            for spike in (*act.held.values(), *(s for held in act.watch.values() for s in held.values())):
                spike.signal = self.policy.signal_plans[spike.signal.index]
        for spike in self.spikes:
            spike.signal = self.policy.signal_plans[spike.signal.index]
        for rule in self.policy.rule_plans[known:]:  # report a predicate that raises
            for need in (need for clause in rule.clauses for need in clause.needs):
                for spike in self.spikes:
                    if spike.signal is need.signal:
                        self.passes(need, spike.payload)

    def on_finish(self, event: events.Finish) -> None:
        """Settle a run whose function has ended (L18)."""
        run = self.running.pop(event.run)
        rule, told, outcome, exception = run.rule, run.told, event.kind, event.exception
        if told == "timeout":
            outcome, exception = "failed", RuleTimeout("late")
        elif outcome == "resigned" and run.wrote:
            outcome, exception = "failed", RuleError("resigned after a write")
        elif told and outcome in ("done", "resigned"):
            outcome = told
        fired = run.wrote or told == "interrupted" or outcome in ("done", "retired", "interrupted")
        if told == "wiped" and not run.wrote:
            fired = False
        if rule.cooldown and fired:
            self.ran[rule.index] = self.now
        groups = list(dict.fromkeys(group.root() for group in run.took))
        for group in groups:
            for slot in rule.slots:
                if fired:
                    group.taken[slot] = None
                elif (runs := group.taken.get(slot)) is not None:
                    group.taken[slot] = [one for one in runs if one is not run]
                    if not group.taken[slot]:
                        del group.taken[slot]
        if fired:
            for other in list(self.acts):
                if other is not run and other.state < RUNS and not other.rule.slotset.isdisjoint(rule.slotset):
                    for group in groups:
                        self.lose(other, self.of_group(other, group))
        else:
            self.give_up(run, run.parents)
        self.out.append(Ended(run.number, rule.name, outcome, fired))
        heard = [one.signal.name for spike in run.held.values() for one in spike.ancestry()]
        self.end(run)
        if event.kind == "retired":
            self.retired.add(rule.index)
            for act in [a for a in self.acts if a.rule is rule and a.state < RUNS]:
                self.end(act)
        if outcome == "failed":
            failure = exception or RuleError("failed")
            self.out.append(Failed(rule.name, failure))
            if "core:error" not in heard:
                self.failures.append(RuleFailure(rule.name, failure))
