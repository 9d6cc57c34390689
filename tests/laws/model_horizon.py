"""The part of the interpreter of the laws that finds out which spikes may still come (L16)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from laws.model_records import GATHERS, RUNS, Act, Group

if TYPE_CHECKING:
    from laws.model import Model

NO, PERHAPS, SURE = 0, 1, 2
"""How a missing spike may come: not at all; by an input or a rule elsewhere (L16 iii); by work in progress."""


class Derivation:
    """Find out whether missing spikes may still come (L16), if the activations in `still` do nothing.

    The signals that may come to a group are a least fixed point: `known` grows until nothing more follows.
    """

    def __init__(self, model: Model, still: frozenset[Act]) -> None:
        self.model = model
        self.still = still
        self.known: dict[tuple[Any, Group, frozenset[int]], int] = {}
        self.found: dict[Act, list[Group]] = {}
        self.alive: dict[Group, set[int]] = {}

    def groups(self, act: Act) -> list[Group]:
        if act not in self.found:
            self.found[act] = act.groups()
        return self.found[act]

    def rules(self, group: Group) -> set[int]:
        """Return the rules with an activation in a group."""
        if group not in self.alive:
            self.alive[group] = {act.rule.index for act in self.model.acts if group in self.groups(act)}
        return self.alive[group]

    def rival(self, clause: Any, act: Act | None, group: Group) -> int:
        """Return how a rival may become ready; `act` is None for the activation that stands by."""
        if act is None and any(self.waits_elsewhere(clause, other, group) for other in self.model.acts):
            return NO  # an older activation of the clause already waits for the group's signals
        return self.solve(clause, act, group)

    def waits_elsewhere(self, clause: Any, act: Act, group: Group) -> bool:
        able = act.clause is clause and act.state == GATHERS and act not in self.still
        return able and group not in self.groups(act) and bool(self.solve(clause, act, group))

    def solve(self, clause: Any, act: Act | None, group: Group) -> int:
        while True:
            before = len(self.known), sum(self.known.values())
            strength = self.viable(clause, act, group, clause.rule.slotset)
            for signal, home, slots in list(self.known):
                if self.known[signal, home, slots] != SURE:
                    self.known[signal, home, slots] = self.caused(signal, home, slots)
            if before == (len(self.known), sum(self.known.values())):
                return strength

    def comes(self, signal: Any, group: Group, slots: frozenset[int]) -> int:
        """Return how a signal may come to a group, as far as is known."""
        if self.causes(signal, wide=False).isdisjoint(self.rules(group)):
            return NO  # every chain of causes in the group begins with an activation there
        return self.known.setdefault((signal, group, slots), NO)

    def viable(self, clause: Any, act: Act | None, group: Group, slots: frozenset[int]) -> int:
        """Return how a clause may become ready through work in `group`.

        Without a spike of the group, the clause has a stake there only if it waits for a signal of the group's horizon.
        """
        model = self.model
        model.steps += 1
        if clause.rule.index in model.retired or (act is None and group.consumed(clause.rule.slots)):
            return NO
        stands_on = [] if act is None else self.groups(act)
        lacks = list(clause.needs) if act is None else act.lacks()
        elsewhere = [g for g in stands_on if g is not group]
        here: list[int] = []
        best: list[int] = []
        while lacks:
            need = lacks.pop(0)
            if need.detached:
                mine, other = NO, self.seen(need, group, slots)
            else:
                kin = [need, *(n for n in lacks if n.bit & need.kin)]
                lacks = [n for n in lacks if n not in kin]
                held = None if act is None else self.kin_group(act, need)
                mine = other = NO
                if held in (None, group):
                    mine = min(self.comes(n.signal, group, slots) for n in kin)
                for home in elsewhere:
                    if held in (None, home):
                        other = max(other, min(self.comes(n.signal, home, slots) for n in kin))
                if held is None and all(self.from_outside(n.signal, group) for n in kin):
                    other = max(other, PERHAPS)
            here.append(mine)
            best.append(max(mine, other))
        if group in stands_on:
            strength = min(best, default=SURE)
        else:
            strength = max((min(mine, *best[:k], *best[k + 1 :], SURE) for k, mine in enumerate(here)), default=NO)
        for slot, guard in clause.guards:
            opens = model.opens_quietly(slot, guard)
            if not opens and self.comes(slot.signals[0], group, slots) != SURE:
                return NO
        return strength

    def kin_group(self, act: Act, need: Any) -> Group | None:
        for other in act.clause.needs:
            if other.bit & need.kin and other.index in act.held:
                return act.held[other.index].group.root()
        return None

    def seen(self, need: Any, group: Group, slots: frozenset[int]) -> int:
        """Return how a detached constraint may be met."""
        if any(s.signal is need.signal and self.model.fits(need, s) for s in self.model.spikes):
            return SURE
        outside = PERHAPS if self.from_outside(need.signal, group) else NO
        return max(self.comes(need.signal, group, slots), outside)

    def caused(self, signal: Any, group: Group, slots: frozenset[int]) -> int:
        """Return how a rule of a group may raise a signal."""
        best = NO
        for rule in self.model.policy.rule_plans:
            if rule.detached or signal.index not in rule.raises or rule.index in self.model.retired:
                continue
            if not rule.slotset.isdisjoint(slots):
                continue  # in one group each slot is written once (L19)
            for act in self.model.acts:
                if act.rule is rule and act not in self.still:
                    if act.state < RUNS:
                        best = max(best, self.viable(act.clause, act, group, slots | rule.slotset))
                    elif group in self.groups(act):
                        best = SURE
            for clause in rule.clauses:
                best = max(best, self.viable(clause, None, group, slots | rule.slotset))
        return best

    def from_outside(self, signal: Any, group: Group) -> bool:
        """Return whether an input, or a live rule of another group, may raise a signal (L16 iii)."""
        if signal.input:
            return True
        wide, narrow = self.causes(signal, wide=True), self.causes(signal, wide=False)
        return any(
            act.rule.index in wide and (act.rule.index not in narrow or group not in self.groups(act))
            for act in self.model.acts
            if act not in self.still
        )

    def causes(self, signal: Any, *, wide: bool) -> set[int]:
        """Return the rules from which a chain of effects leads to a signal.

        With `wide`, the chain can also lead through detached rules and constraints.
        """
        known = self.model.chains.get((signal, wide))
        if known is not None:
            return known
        rules: set[int] = set()
        self.model.chains[signal, wide] = rules
        signals = [signal]
        for one in signals:
            for rule in self.model.policy.rule_plans:
                if one.index in rule.raises and (wide or not rule.detached):
                    rules.add(rule.index)
                    for need in (n for clause in rule.clauses for n in clause.needs):
                        if need.signal not in signals and not (need.signal.input if wide else need.detached):
                            signals.append(need.signal)
        return rules
