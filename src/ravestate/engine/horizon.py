"""Decide whether a rival may still become ready (law L16).

Read first: docs/explanation/processing-model.md, which explains rivals, causal groups, patience and laws such as L16.

A rival may still become ready if each of its constraints without a spike (its missing *needs*) may yet get one. Each of
its slot predicates must be true, or work in progress may yet make it true.

The horizon of a group is the set of signals that rules of the group may yet cause. A rule may cause a signal if the
rule runs, or if its constraints are met or may yet be met. So whether a signal may come depends on whether other
signals may come. The horizon is the smallest set that satisfies this definition (a least fixed point over an and-or
graph).

The engine does not compute the whole set, because few signals matter at a time. It asks about one signal, and searches
backwards from this signal to live activations. A signal to which no live rule of the group leads (`Causes.ancestors`)
needs no such search.

Each such search is a *derivation*. Its result is a *strength*:

``SURE``         work that will end by itself may lead to the signal: a run, a ready activation, or an activation whose
                 spikes are still too young
``SPECULATIVE``  an input, or a live rule of another group, must help; this help may never come, so the wait needs a
                 limit (the rival's `patience`)
``NO``           nothing leads to the signal

A rule that would take one of the rival's own slots cannot help the rival: in one group, only one rule writes a slot
(L19). The *asking activation* (the one that wants to run, and for which the engine judges the rival) cannot help
either; nor can an activation that waits for the asking one. These activations count as *inert*: doing nothing.

A chain of causes may be too long for recursion. So each step of a derivation is a generator, a `Step`, which yields the
steps whose strengths it needs. `_solve` runs the steps, and keeps the waiting steps on a stack.

In a cycle of causes, a derivation needs its own result. It uses its *bound* instead: the strength proven so far, at
first `NO`. A strength that rests on a bound is *open*. If a bound has risen when the oldest derivation of the cycle
ends, the engine derives the cycle again. Otherwise, the open strengths are final. A strength rises at most twice.
So the engine derives a cycle of n signals again at most 2n times.
"""

from __future__ import annotations

from collections.abc import Generator, Mapping, Sequence, Set
from typing import Any, Final

from ravestate.engine.activation import ENDED, GATHERING, NEVER, OUTSIDE, RULE, RUNNING, SEEN, Activation
from ravestate.engine.group import Group
from ravestate.engine.state import State
from ravestate.engine.stuck import Stuck
from ravestate.policy.model import Clause, Need

NO: Final = 0
SPECULATIVE: Final = 1
SURE: Final = 2

SlotNumbers = frozenset[int]
Place = tuple[int, Group, SlotNumbers]
"""The goal of a derivation: a signal (its index), the group that may cause it, and the indices of slots that no helping
rule may write."""

FINAL: Final = 1 << 60
STALE: Final = -1
"""Special values for the last item of an entry of `Horizon._known`. `FINAL` marks a final strength. `STALE` marks a
strength that the engine must derive again. Any other value is a depth: how many older derivations were in progress."""

Step = Generator[Any, int, int]
"""A step of a derivation: it yields further steps, receives the strength of each, and returns its own strength."""


class Horizon:
    """The horizons of the engine's groups at one moment, for one asking activation.

    A `Horizon` changes no spike, group or activation.

    Args:
        state: The state of the engine.
        inert: The activations that count as doing nothing: the asking activation, and the activations that wait for it.
        stuck: More activations that count as doing nothing, because they wait only for each other.

    Attributes:
        roots: The live activations on which the latest derivation with the result `SURE` rests.
        visited: The groups on whose state the results depend.
        hopes: The changes after which the results may differ. A key is a kind of change (`RULE`, `OUTSIDE` or `SEEN`,
            see ``activation.py``) and the index of a rule or signal. The value is a count. For `OUTSIDE`, the count is
            a limit. If one activation of a rule changes, and the rule has more than this many other activations, the
            results stay the same. For the other kinds, the count is 0.
        recheck: The time (seconds) at which the first spike that the results need for a detached constraint becomes too
            old.
    """

    __slots__ = (
        "_by_rule",
        "_depth",
        "_far",
        "_known",
        "_open",
        "_risen",
        "_since",
        "_inert",
        "hopes",
        "stuck",
        "recheck",
        "roots",
        "state",
        "inert",
        "visited",
    )

    def __init__(self, state: State, inert: Set[Activation], stuck: Sequence[Stuck] = ()) -> None:
        self.state = state
        self.inert = inert
        self.stuck = stuck
        self._inert: dict[int, int] | None = None  # rule → how many of its activations are in `inert`
        # Place → (its strength; its roots, if the strength is SURE; the depth of the oldest derivation on whose bound
        # the strength rests).
        self._known: dict[Place, tuple[int, tuple[Activation, ...], int]] = {}
        self._depth = 0  # how many derivations are in progress
        self._since = FINAL  # the depth of the oldest derivation whose bound the present derivation has read
        self._open: list[Place] = []  # the places that rest on bounds
        self._risen = 0  # how often a bound has risen
        self._far: dict[tuple[int, Group], bool] = {}  # the results of `_outside`
        self._by_rule: dict[Group, Mapping[int, Mapping[Activation, None]]] = {}
        self.roots: list[Activation] = []
        self.visited: dict[Group, None] = {}
        self.hopes: dict[tuple[int, int], int] = {}
        self.recheck = NEVER

    def is_inert(self, activation: Activation) -> bool:
        """Return whether an activation counts as doing nothing."""
        return activation in self.inert or (bool(self.stuck) and self._is_stuck(activation))

    def _is_stuck(self, activation: Activation) -> bool:
        return any([activation in stuck for stuck in self.stuck])

    def judge(self, clause: Clause, activation: Activation | None, group: Group) -> tuple[int, tuple[Activation, ...]]:
        """Return the strength with which a clause may become ready in a group. For `SURE`, also return the `roots`.

        `activation` is None for the clause's activation on stand-by, which holds no spike yet (see ``activation.py``).
        An activation without a spike of the group is a rival there only if the group may yet raise a signal that the
        activation lacks.
        """
        self.roots.clear()
        strength = _solve(self._viable(clause, activation, group, clause.rule.slotset))
        return strength, tuple(dict.fromkeys(self.roots))

    def forget(self, activation: Activation) -> None:
        """Discard all derivations that may rest on an activation that is about to end."""
        rule = activation.clause.rule
        if self.state.causes.helpful.isdisjoint(rule.raises):
            return  # no derivation rests on this activation
        self._known.clear()
        self._far.clear()
        self._inert = None
        self._by_rule.clear()

    def open_bits(self, clause: Clause, group: Group) -> int:
        """Return, as bits, the needs of a clause for which rules of a group may yet raise a spike.

        The result is 0 if every activation of the clause takes all its spikes from one group.
        """
        if clause.apart:
            return 0
        reach = self._rules(group).keys()
        ancestors = self.state.causes.ancestors
        bits = 0
        for need in clause.needs:
            if not need.detached and not reach.isdisjoint(ancestors(need.signal.index)):
                bits |= need.bit
        return bits

    def elsewhere(self, clause: Clause, group: Group) -> list[Activation]:
        """Return a clause's activations that hold no spike of the group, but lack a spike that the group may cause."""
        open_bits = self.open_bits(clause, group)
        if not open_bits:
            return []
        self.hopes[RULE, clause.rule.index] = 0
        return [
            one
            for one in self.state.active.get(clause.rule.index, ())
            if one.clause is clause
            and one.state == GATHERING
            and one.missing & open_bits
            and not self.is_inert(one)
            and not group.has(one)
        ]

    def _viable(self, clause: Clause, activation: Activation | None, group: Group, slots: SlotNumbers) -> Step:
        """Return the strength of a clause, for `judge`. Rules that write one of `slots` cannot help."""
        rule = clause.rule
        if rule.index in self.state.retired:
            return NO
        mark = len(self.roots)
        member = False
        others: list[Group] = []
        if activation is None:
            missing = clause.all_bits
            if group.taken and group.finished(rule.slots):
                return NO
        else:
            missing = activation.missing
            for home in activation.firm_groups():
                if home is group:
                    member = True
                else:
                    others.append(home)
                    self.visited[home] = None
            if not missing:
                self.roots.append(activation)  # the activation is ready, or will be when its spikes are old enough
        # One entry for each missing need. Needs that must hold spikes of the same group (kin) share an entry.
        # `here`: the strength in this group; `best`: the strength in any group.
        here: list[int] = []
        best: list[int] = []
        answered = 0
        for need in clause.needs:
            if not need.bit & missing or need.bit & answered:
                continue
            if need.detached:
                mine, other = NO, (yield from self._seen(need, group, slots))
            else:
                answered |= need.kin
                kin = [n for n in clause.needs if n.bit & need.kin & missing]
                held = activation.held(need.kin) if activation is not None and need.kin != need.bit else None
                own = None if held is None else held.group.root()
                mine = other = NO
                if own is None or own is group:
                    mine = yield from self._all(kin, group, slots)
                for there in others:
                    if mine == SURE or other == SURE:
                        break
                    if own is None or own is there:
                        strength = yield from self._all(kin, there, slots)
                        other = max(other, strength)
                if max(mine, other) == NO and own is None and all(self._outside(n, group) for n in kin):
                    other = SPECULATIVE
            if mine == NO and other == NO:
                del self.roots[mark:]
                return NO
            here.append(mine)
            best.append(max(mine, other))
        strength = min(best, default=SURE)
        if not member:  # the clause is a rival here only if this group itself may meet one of its needs
            strength = max((min(mine, *best[:k], *best[k + 1 :], SURE) for k, mine in enumerate(here)), default=NO)
        if strength == NO or (clause.guards and not (yield from self._guards(clause, group, slots))):
            del self.roots[mark:]
            return NO
        return strength

    def _all(self, needs: list[Need], group: Group, slots: SlotNumbers) -> Step:
        """Return the strength with which one group may meet all of several needs."""
        weakest = SURE
        for need in needs:
            strength = yield from self._comes(need.signal.index, group, slots)
            weakest = min(weakest, strength)
            if not weakest:
                break
        return weakest

    def _seen(self, need: Need, group: Group, slots: SlotNumbers) -> Step:
        """Return the strength with which a spike of any group may meet a detached need."""
        self.hopes[SEEN, need.signal.index] = 0
        spike = self.state.newest(need)
        if spike is not None:
            self.visited[spike.group.root()] = None
            self.recheck = min(self.recheck, spike.born + need.max_age)
            return SURE
        strength = yield from self._comes(need.signal.index, group, slots)
        return strength or (SPECULATIVE if self._outside(need, group) else NO)

    def _guards(self, clause: Clause, group: Group, slots: SlotNumbers) -> Generator[Any, int, bool]:
        """Return whether every slot predicate of a clause is true, or tests a slot that work in progress in this group
        may change."""
        for slot, guard in clause.guards:
            if self.state.opens(slot, guard):
                continue
            if (yield from self._comes(slot.signals[0].index, group, slots)) != SURE:
                return False
        return True

    def _comes(self, signal: int, group: Group, slots: SlotNumbers) -> Step:
        """Return the strength with which a signal lies in the horizon of a group."""
        if self._rules(group).keys().isdisjoint(self.state.causes.ancestors(signal)):
            return NO
        known = self._known.get((signal, group, slots))
        if known is None or known[2] == STALE:
            return (yield self._derive((signal, group, slots), NO if known is None else known[0]))
        self._since = min(self._since, known[2])
        self.roots.extend(known[1])
        return known[0]

    def _derive(self, place: Place, bound: int) -> Step:
        """Return the strength of a place. The result is at least `bound`, which an earlier derivation has proven."""
        known, mark = self._known, len(self.roots)
        depth, first, before = self._depth, len(self._open), self._since
        self._depth += 1
        while True:
            known[place] = bound, (), depth
            self._since, risen = FINAL, self._risen
            best = yield from self._caused(*place)
            since = self._since
            if best == SURE:
                self._close(first, STALE)
                known[place] = SURE, tuple(dict.fromkeys(self.roots[mark:])), FINAL
                since = FINAL
            elif since < depth:  # this derivation is part of the cycle of an older one
                self._risen += best > bound
                known[place] = best, (), since
                self._open.append(place)
            elif since == FINAL or (best == bound and risen == self._risen):
                self._close(first, FINAL)
                known[place] = best, (), FINAL
                since = FINAL
            else:
                self._close(first, STALE)
                bound = best
                continue
            self._depth -= 1
            self._since = min(before, since)
            return best

    def _close(self, first: int, since: int) -> None:
        """Mark strengths of open places as `since` says: final or stale. Begin with the place at `first` in `_open`."""
        for place in self._open[first:]:
            self._known[place] = self._known[place][0], (), since
        del self._open[first:]

    def _caused(self, signal: int, group: Group, slots: SlotNumbers) -> Step:
        """Return the strength of the surest way in which a rule may raise a signal in a group."""
        mark = len(self.roots)
        by_rule, retired = self._by_rule[group], self.state.retired
        best = NO
        for rule in self.state.causes.causes[signal]:
            if not rule.slotset.isdisjoint(slots) or rule.index in retired:
                continue
            inner = slots | (rule.slotset & self.state.causes.contested) if rule.slots else slots
            ways: list[tuple[Clause, Activation | None]] = []
            for activation in by_rule.get(rule.index, ()):
                if activation.state >= RUNNING:
                    self.roots.append(activation)
                    return SURE
                if not self.is_inert(activation):
                    ways.append((activation.clause, activation))
            for clause in rule.clauses:
                ways += [(clause, activation) for activation in self.elsewhere(clause, group)]
                ways.append((clause, None))
            for clause, helper in ways:
                strength = yield self._viable(clause, helper, group, inner)
                if strength == SURE:
                    return SURE
                del self.roots[mark:]
                best = max(best, strength)
        return best

    def _rules(self, group: Group) -> Mapping[int, Mapping[Activation, None]]:
        """Return the members of a group by the index of their rule, and record that the results depend on the group."""
        found = self._by_rule.get(group)
        if found is None:
            self.visited[group] = None
            found = self._by_rule[group] = group.by_rule(self.state.causes)
        return found

    def _outside(self, need: Need, group: Group) -> bool:
        """Return whether an input, or a live rule of another group, might raise the need's signal (L16 iii)."""
        signal = need.signal
        if signal.input:
            return True
        found = self._far.get((signal.index, group))
        if found is None:
            found = self._far[signal.index, group] = self._is_far(signal.index, group)
        return found

    def _is_far(self, signal: int, group: Group) -> bool:
        """Return whether a live rule of another group might raise a signal. Record in `hopes` that the answer may
        change."""
        causes = self.state.causes
        wide = causes.wide_ancestors(signal)
        if wide:
            hope = (OUTSIDE, signal)
            most = self.hopes.setdefault(hope, 0)
            narrow = causes.ancestors(signal)
            live = self.state.active
            for rule in wide if len(wide) < len(live) else live:
                alive = len(live.get(rule, ()))
                if alive and rule in wide:
                    helpless = self._helpless(rule, group, near=rule in narrow)
                    most = self.hopes[hope] = max(most, helpless)
                    if alive > helpless:
                        return True
        return False

    def _helpless(self, rule: int, group: Group, *, near: bool) -> int:
        """Count the activations of a rule that cannot help `group` from outside.

        These are the inert activations and, if `near`, the members of `group`. `near` says that no effect of a detached
        rule lies between the rule and the signal. If so, members help from inside the group, not from outside.
        """
        if self._inert is None:
            self._inert = {}
            for activation in self.inert:
                if activation.state != ENDED and not self._is_stuck(activation):
                    number = activation.clause.rule.index
                    self._inert[number] = self._inert.get(number, 0) + 1
        count = self._inert.get(rule, 0)
        for stuck in self.stuck:
            count += stuck.counts.get(rule, 0)
        if near:
            for activation in self._rules(group).get(rule, ()):
                count += not self.is_inert(activation)
        return count


def _solve(step: Step) -> int:
    """Run a derivation with all its steps, and return its strength.

    If a step needs the strength of another step, it yields that step to this loop, as `_comes` and `_caused` do. A
    ``yield from`` only divides one step into several functions.
    """
    waiting: list[Step] = []
    strength: Any = None
    while True:
        try:
            further = step.send(strength)
        except StopIteration as end:
            strength = end.value
            if not waiting:
                return strength
            step = waiting.pop()
        else:
            waiting.append(step)
            step, strength = further, None
