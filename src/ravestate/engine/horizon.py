"""The horizon (L16): whether the missing constraints of a rival may yet be met.

A signal is in the horizon of a group if some rule of the group may yet cause it. Such a rule runs, or its own
constraints are met or may still be met. This is a least fixed point over an and-or graph. Few signals matter at a time,
so the engine derives each one backwards, from its causes to live activations. A static closure (`Causes.ancestors`)
cuts off the causes that no live rule of the group can reach.

A derivation has one of three strengths:

``FIRM``         it rests on work in progress: runs, ripening spikes, ready activations
``SPECULATIVE``  a step needs an input, or a live rule of another group: the signal may never come, and
                 only patience ends the wait
``NO``           nothing leads to the signal

A rule that would take one of the rival's own slots cannot help the rival: in one group a slot is written once (L19).

A derivation may have as many steps as the policy has signals. So each of its steps is a generator, a `Step`: it yields
the steps whose strengths it needs, and `_solve` keeps those that wait on a stack of its own.
"""

from __future__ import annotations

from collections.abc import Generator
from typing import TYPE_CHECKING, Any

from ravestate.engine.activation import RUNNING, Activation
from ravestate.policy.model import Clause, Need

if TYPE_CHECKING:
    from ravestate.engine.agenda import Agenda as Engine
    from ravestate.engine.group import Group

NO, SPECULATIVE, FIRM = 0, 1, 2

Slots = frozenset[int]
Step = Generator[Any, int, int]
"""A step of a derivation: it yields further steps, receives the strength of each, and returns its own strength."""


class Horizon:
    """The horizons of the engine's groups at one moment.

    Attributes:
        roots: The live activations on which the latest firm derivation rests.
        visited: The groups on whose state the latest results depend.
        hopes: Whether a needed signal may come only from a live rule of another group.
    """

    __slots__ = ("_by_rule", "_cuts", "_judged", "_known", "_path", "engine", "hopes", "roots", "visited")

    def __init__(self, engine: Engine) -> None:
        self.engine = engine
        engine.unfold_all()
        self._cuts = 0  # how often a cycle was cut
        self._path: set[int] = set()  # the numbers of the signals whose derivation is in progress
        self._known: dict[tuple[int, Group, Slots], tuple[int, tuple[Activation, ...]]] = {}
        self.hopes = False
        self.roots: list[Activation] = []
        self.visited: dict[Group, None] = {}
        self._by_rule: dict[Group, dict[int, list[Activation]]] = {}
        self._judged: dict[tuple[Clause, Activation | None, Group], tuple[int, dict[Activation, None]]] = {}

    def viable(self, clause: Clause, activation: Activation | None, group: Group, slots: Slots) -> int:
        """Return the strength with which a clause may become ready in a group. `activation` is None for a stand-by.

        A clause in stand-by has a stake in the group only if a signal of the group's horizon is among its needs.
        """
        return _solve(self._viable(clause, activation, group, slots))

    def judge(self, clause: Clause, activation: Activation | None, group: Group) -> tuple[int, dict[Activation, None]]:
        """Return how viable a rival is, and the activations on which this depends. All askers get the same result."""
        known = self._judged.get((clause, activation, group))
        if known is None:
            self.roots.clear()
            strength = self.viable(clause, activation, group, clause.rule.slotset)
            known = self._judged[clause, activation, group] = strength, dict.fromkeys(self.roots)
        return known

    def _viable(self, clause: Clause, activation: Activation | None, group: Group, slots: Slots) -> Step:
        rule = clause.rule
        if rule.index in self.engine.retired:
            return NO
        mark = len(self.roots)
        if activation is None:
            missing = clause.all_bits
            if group.taken and group.finished(rule.slots):
                return NO
        else:
            missing = activation.missing
            if not missing:
                self.roots.append(activation)  # the activation is ready, or will ripen
        # For each need, or set of kin needs: how firmly this group may meet it, and how firmly any group may.
        here: list[int] = []
        best: list[int] = []
        answered = 0
        for need in clause.needs:
            if not need.bit & missing or need.bit & answered:
                continue
            if need.detached:
                mine, other = NO, (yield from self._detached(need, group, slots))
            elif need.kin == need.bit:
                mine = self._at_once(need.signal.index, group, slots)
                if mine is None:
                    mine = yield self._caused(need.signal.index, group, slots)
                other = NO if mine == FIRM else self._anywhere(need, group)
            else:
                answered |= need.kin
                mine, other = yield from self._kin(need, activation, missing, group, slots)
            if mine == NO and other == NO:
                del self.roots[mark:]
                return NO
            here.append(mine)
            best.append(max(mine, other))
        strength = min(best, default=FIRM)
        if activation is None:  # this group must meet one need itself: help from other groups creates no stake
            strength = max(
                (min(mine, *best[:k], *best[k + 1 :]) if len(best) > 1 else mine for k, mine in enumerate(here)),
                default=NO,
            )
        if strength == NO or (clause.guards and not (yield from self._guards(clause, group, slots))):
            del self.roots[mark:]
            return NO
        return strength

    def _anywhere(self, need: Need, group: Group) -> int:
        """Return the strength with which a live spike, an input, or a rule of another group may meet a need."""
        if self._live(need):
            return FIRM
        return SPECULATIVE if self._elsewhere(need, group) else NO

    def _detached(self, need: Need, group: Group, slots: Slots) -> Step:
        """Return the strength with which anything may meet a detached need."""
        if self._live(need):
            return FIRM
        return (yield from self._comes(need.signal.index, group, slots)) or self._anywhere(need, group)

    def _kin(
        self, need: Need, activation: Activation | None, missing: int, group: Group, slots: Slots
    ) -> Generator[Any, int, tuple[int, int]]:
        """Return how firmly this group, and how firmly any group, may meet the kin needs, all of them at once (L12)."""
        kin = [n for n in need.clause.needs if n.bit & need.kin & missing]
        held = activation.held(need.kin) if activation is not None else None
        home = group if held is None else held.group.root()
        mine = FIRM
        for one in kin:
            comes = yield from self._comes(one.signal.index, home, slots)
            mine = min(mine, comes)
        if held is not None or mine == FIRM:
            return mine, NO
        return mine, (SPECULATIVE if all(self._elsewhere(n, group) for n in kin) else NO)

    def _guards(self, clause: Clause, group: Group, slots: Slots) -> Generator[Any, int, bool]:
        """Return whether each of a clause's predicates on slots is true, or its slot may yet change in this group."""
        engine = self.engine
        for slot, guard in clause.guards:
            if engine.holds(slot, guard, clause.rule):
                continue
            if (yield from self._comes(slot.signals[0].index, group, slots)) != FIRM:
                return False
        return True

    def _live(self, need: Need) -> bool:
        """Return whether a live spike could meet a need (L16 i)."""
        spike = self.engine.live_spike(need)
        if spike is not None:
            self.visited[spike.group.root()] = None
        return spike is not None

    def _comes(self, signal: int, group: Group, slots: Slots) -> Step:
        """Return the strength with which a signal lies in the horizon of a group."""
        strength = self._at_once(signal, group, slots)
        return (yield self._caused(signal, group, slots)) if strength is None else strength

    def _at_once(self, signal: int, group: Group, slots: Slots) -> int | None:
        """Return the strength with which a signal lies in a group's horizon, or None if a derivation must find it."""
        if signal in self._path:
            self._cuts += 1
            return NO
        if self._rules(group).keys().isdisjoint(self.engine.policy.causes.ancestors(signal)):
            return NO
        known = self._known.get((signal, group, slots))
        if known is None:
            return None
        self.roots.extend(known[1])
        return known[0]

    def _caused(self, signal: int, group: Group, slots: Slots) -> Step:
        """Return the strength with which one of the rules that may raise a signal will do so."""
        cuts, mark = self._cuts, len(self.roots)
        by_rule, retired = self._by_rule[group], self.engine.retired
        self._path.add(signal)
        best = NO
        for rule in self.engine.policy.causes.causes[signal]:
            if not rule.slotset.isdisjoint(slots) or rule.index in retired:
                continue
            inner = slots | rule.slotset if rule.slots else slots
            live = by_rule.get(rule.index, ())
            for clause, activation in [*((a.clause, a) for a in live), *((c, None) for c in rule.clauses)]:
                if activation is not None and activation.state >= RUNNING:
                    self.roots.append(activation)
                    best = FIRM
                else:
                    strength = yield self._viable(clause, activation, group, inner)
                    best = max(best, strength)
                if best == FIRM:
                    break
            if best == FIRM:
                break
        self._path.discard(signal)
        if self._cuts == cuts:  # the result does not depend on the path that led here
            self._known[signal, group, slots] = best, tuple(self.roots[mark:])
        return best

    def _rules(self, group: Group) -> dict[int, list[Activation]]:
        found = self._by_rule.get(group)
        if found is None:
            self.visited[group] = None
            found = self._by_rule[group] = {}
            for activation in group.members:
                found.setdefault(activation.clause.rule.index, []).append(activation)
        return found

    def _elsewhere(self, need: Need, group: Group) -> bool:
        """Return whether an input, or a live rule of another group, might raise the need's signal (L16 iii)."""
        signal = need.signal
        if signal.input:
            return True
        causes = self.engine.policy.causes
        wide = causes.wide_ancestors(signal.index)
        if wide:
            narrow = causes.ancestors(signal.index)
            for rule, activations in self.engine.active.items():
                if rule in wide and (rule not in narrow or any(a not in group.members for a in activations)):
                    self.hopes = True
                    return True
        return False


def _solve(step: Step) -> int:
    """Run a derivation with all its steps, and return its strength."""
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
