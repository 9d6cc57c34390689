"""What may still come (L16): whether a rival's missing constraints may yet be met.

The theory. A signal is in the horizon of a group if some rule of the group may yet cause it: a rule that
runs, or one whose own constraints are met or may still be met. That is a least fixed point over an and-or
graph, and it is asked for few signals at a time; so it is derived backwards, from the missing signal over
its causes to live activations, and a static closure (`Causes.ancestors`) cuts off what no live rule of the
group can reach.

A derivation has one of three strengths:

``FIRM``         it rests on what is in progress: runs, ripening spikes, ready activations
``SPECULATIVE``  some step of it needs an input, or a live rule of another group: it may never come, and
                 only patience bounds it
``NO``           nothing leads there

A rule that would take a slot of the rival's own cannot help it: in one group a slot is written once (L19).
"""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

from ravestate.engine.activation import RUNNING, Activation
from ravestate.policy.model import Clause, Need

if TYPE_CHECKING:
    from ravestate.engine.group import Group
    from ravestate.engine.waves import Waves as Engine

__all__ = ["FIRM", "NO", "SPECULATIVE", "Horizon"]

NO, SPECULATIVE, FIRM = 0, 1, 2

FRAMES = 8
"""More than the calls by which a derivation gets from one signal to the next. None of them passes through a function in
C that calls back, which would use up the interpreter's stack."""

Path = frozenset[int]
Slots = frozenset[int]


class Horizon:
    """The horizons of the engine's groups at one moment; made for one question of consent, then thrown away.

    Attributes:
        roots: The live activations on which the latest firm derivation rests.
        visited: The groups that were looked at.
        hopes: Whether something was found that only a live rule of another group may bring.
    """

    __slots__ = ("_by_rule", "_cuts", "_judged", "_known", "engine", "hopes", "roots", "visited")

    def __init__(self, engine: Engine) -> None:
        self.engine = engine
        engine.unfold_all()
        self._cuts = 0  # how often a cycle was cut
        self._known: dict[tuple[int, Group, Slots], tuple[int, tuple[Activation, ...]]] = {}
        self.hopes = False
        self.roots: list[Activation] = []
        self.visited: dict[Group, None] = {}
        self._by_rule: dict[Group, dict[int, list[Activation]]] = {}
        self._judged: dict[tuple[Clause, Activation | None, Group], tuple[int, dict[Activation, None]]] = {}

    def viable(self, clause: Clause, activation: Activation | None, group: Group, slots: Slots) -> int:
        """How firmly a clause, by an activation of it or (None) in stand-by, may still become ready in a group.

        A clause in stand-by has a stake in the group only if a signal of the group's horizon is among its needs.
        """
        mark = len(self.roots)
        try:
            return self._viable(clause, activation, group, slots, frozenset())
        except RecursionError:  # hundreds of pending rules that wait for each other in a row
            del self.roots[mark:]
            limit = sys.getrecursionlimit()
            # Calls from Python to Python take no room on the interpreter's own stack.
            sys.setrecursionlimit(limit + FRAMES * len(self.engine.policy.signal_plans))
            try:
                return self._viable(clause, activation, group, slots, frozenset())
            finally:
                sys.setrecursionlimit(limit)

    def judge(
        self, clause: Clause, activation: Activation | None, group: Group
    ) -> tuple[int, dict[Activation, None]]:
        """How viable a rival is, and on whose progress that depends: the same whoever asks."""
        known = self._judged.get((clause, activation, group))
        if known is None:
            self.roots.clear()
            strength = self.viable(clause, activation, group, clause.rule.slotset)
            known = self._judged[clause, activation, group] = strength, dict.fromkeys(self.roots)
        return known

    def _viable(
        self, clause: Clause, activation: Activation | None, group: Group, slots: Slots, path: Path
    ) -> int:
        rule = clause.rule
        if rule.index in self.engine.retired:
            return NO
        mark = len(self.roots)
        if activation is None:
            missing = clause.all_bits
            if group.finished(rule.slots):
                return NO
        else:
            missing = activation.missing
            if not missing:
                self.roots.append(activation)  # it is ready, or will ripen
        # For each need, or needs that one group must meet: how firmly this group may meet it, and how firmly anything.
        here: list[int] = []
        best: list[int] = []
        answered = 0
        for need in clause.needs:
            if not need.bit & missing or need.bit & answered:
                continue
            if need.detached:
                mine, other = NO, self._detached(need, group, slots, path)
            elif need.kin == need.bit:
                mine = self.comes(need.signal.index, group, slots, path)
                other = NO if mine == FIRM else self._anywhere(need, group)
            else:
                answered |= need.kin
                mine, other = self._kin(need, activation, missing, group, slots, path)
            if mine == NO and other == NO:
                del self.roots[mark:]
                return NO
            here.append(mine)
            best.append(max(mine, other))
        strength = min(best, default=FIRM)
        if activation is None:  # one of them must be met here: what comes from elsewhere gives no stake
            strength = max(
                (
                    min(mine, *best[:k], *best[k + 1 :]) if len(best) > 1 else mine
                    for k, mine in enumerate(here)
                ),
                default=NO,
            )
        if strength == NO or not self._guards(clause, group, slots, path):
            del self.roots[mark:]
            return NO
        return strength

    def _anywhere(self, need: Need, group: Group) -> int:
        """How firmly what is live, an input, or a rule of another group may meet a need."""
        if self._live(need):
            return FIRM
        return SPECULATIVE if self._elsewhere(need, group) else NO

    def _detached(self, need: Need, group: Group, slots: Slots, path: Path) -> int:
        """A need that looks only."""
        if self._live(need):
            return FIRM
        return self.comes(need.signal.index, group, slots, path) or self._anywhere(need, group)

    def _kin(
        self,
        need: Need,
        activation: Activation | None,
        missing: int,
        group: Group,
        slots: Slots,
        path: Path,
    ) -> tuple[int, int]:
        """Needs that one causal group must meet together (coherence, L12)."""
        kin = [n for n in need.clause.needs if n.bit & need.kin & missing]
        held = activation.held(need.kin) if activation is not None else None
        home = group if held is None else held.group.root()
        mine = min([self.comes(n.signal.index, home, slots, path) for n in kin])  # a list: see `FRAMES`
        if held is not None or mine == FIRM:
            return mine, NO
        return mine, (SPECULATIVE if all(self._elsewhere(n, group) for n in kin) else NO)

    def _guards(self, clause: Clause, group: Group, slots: Slots, path: Path) -> bool:
        """Whether its predicates on slots hold, or a slot may yet change in this group."""
        engine = self.engine
        for slot, guard in clause.guards:
            if engine.holds(slot, guard, clause.rule):
                continue
            if self.comes(slot.signals[0].index, group, slots, path) != FIRM:
                return False
        return True

    def _live(self, need: Need) -> bool:
        """Whether a live spike could meet a need (L16 i)."""
        spike = self.engine.live_spike(need)
        if spike is not None:
            self.visited[spike.group.root()] = None
        return spike is not None

    def comes(self, signal: int, group: Group, slots: Slots, path: Path) -> int:
        """How firmly a signal lies in the horizon of a group."""
        if signal in path:
            self._cuts += 1
            return NO
        by_rule = self._rules(group)
        if by_rule.keys().isdisjoint(self.engine.policy.causes.ancestors(signal)):
            return NO
        known = self._known.get((signal, group, slots))
        if known is not None:
            self.roots.extend(known[1])
            return known[0]
        cuts, mark = self._cuts, len(self.roots)
        best = self._caused(signal, by_rule, group, slots, path | {signal})
        if self._cuts == cuts:  # it does not depend on the way by which it was reached
            self._known[signal, group, slots] = best, tuple(self.roots[mark:])
        return best

    def _caused(
        self, signal: int, by_rule: dict[int, list[Activation]], group: Group, slots: Slots, path: Path
    ) -> int:
        """How firmly one of the rules that raise a signal may do so."""
        best = NO
        for rule in self.engine.policy.causes.causes[signal]:
            if not rule.slotset.isdisjoint(slots) or rule.index in self.engine.retired:
                continue
            inner = slots | rule.slotset
            for activation in by_rule.get(rule.index, ()):
                if activation.state >= RUNNING:
                    self.roots.append(activation)
                    return FIRM
                best = max(best, self._viable(activation.clause, activation, group, inner, path))
                if best == FIRM:
                    return FIRM
            for clause in rule.clauses:
                best = max(best, self._viable(clause, None, group, inner, path))
                if best == FIRM:
                    return FIRM
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
        """Whether an input, or a live rule of another group, might bring the signal (L16 iii)."""
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
