"""Leaders: when one activation is refused, the activations behind it need not examine every rival.

An activation is *behind* another if its clause comes later in the order of effective utility. Suppose that a thousand
activations are ready to write one slot, and the group refuses the best one. The group would refuse all others too,
because the best one is a rival of each. So only the best one, the *leader*, asks in full: it examines every rival
(``consent.py``). The others *follow*: they wait for the leader, and examine no other rival.

An activation cannot follow if the utility of a rival lies between the leader's and its own. The leader did not examine
this rival. The activation must examine it: the rival may need pressure, or may lead to a further rival (law L16).
So the activation asks in full, and becomes the leader of the activations behind it.

The leader's effects may also make a rival ready. An activation that asks in full considers this; a follower does not.
So an activation can lead only if none of its effects leads to a rule that writes a slot, or to a slot predicate.
"""

from __future__ import annotations

from ravestate.engine.activation import GATHERING, RUNNING, WAITING, Activation, Refusal
from ravestate.engine.group import Group
from ravestate.engine.state import State
from ravestate.policy.model import Clause


class Leader:
    """A refused activation that other activations follow. It asks only one causal group for consent.

    Attributes:
        activation: The activation.
        next: The best rival behind the leader. Activations behind this rival cannot follow. None if no rival is behind
            the leader.
        recovering: The rivals behind the leader whose rules are still in their cooldown. Their places in the order
            change.
    """

    __slots__ = ("activation", "known", "next", "recovering")

    def __init__(self, activation: Activation) -> None:
        self.activation = activation
        self.known = False  # whether `next` and `recovering` are known; the first follower needs them
        self.next: Clause | None = None
        self.recovering: list[Clause] = []


class Leaders:
    """The leaders of one round of consent (`Agenda.consent_round`); `found` maps a causal group and a set of slots to
    their leader."""

    __slots__ = ("found", "state")

    def __init__(self, state: State) -> None:
        self.state = state
        self.found: dict[tuple[Group, frozenset[int]], Leader] = {}

    def add(self, activation: Activation) -> None:
        """Make a refused activation the leader for its group and slots, if it can lead."""
        groups, rule = activation.firm_groups(), activation.clause.rule
        if len(groups) == 1 and self.state.causes.helpful.isdisjoint(rule.raises):
            self.found[groups[0], rule.slotset] = Leader(activation)

    def refuse(self, activation: Activation) -> Refusal | None:
        """Return the refusal of an activation that follows a leader; None if it must ask in full."""
        groups, clause, standing = activation.firm_groups(), activation.clause, self.state.standing
        slots = clause.rule.slotset
        leader = self.found.get((groups[0], slots)) if len(groups) == 1 else None
        if leader is None or leader.activation.state != WAITING or not groups[0].taken.keys().isdisjoint(slots):
            return None
        first = leader.activation.clause
        if not standing.is_ahead(first, clause):
            return None
        if not leader.known:
            self._look_behind(leader, groups[0])
        between = [leader.next, *leader.recovering] if leader.next is not None else leader.recovering
        if not all([theirs is clause or standing.is_ahead(clause, theirs) for theirs in between]):
            return None
        refusal = Refusal()
        refusal.leader = leader.activation
        refusal.interests[groups[0]] = None
        refusal.name(first)
        refusal.blockers[leader.activation] = None
        refusal.sure.append((leader.activation,))
        if clause.rule.cooldown or first.rule.cooldown or leader.recovering:
            refusal.recheck = min([standing.crossing(clause, theirs) for theirs in (first, *leader.recovering)])
        return refusal

    def _look_behind(self, leader: Leader, group: Group) -> None:
        """Find the rivals behind a leader. An activation behind such a rival cannot follow."""
        state, first = self.state, leader.activation.clause
        causes, slots = state.causes, first.rule.slots
        found: dict[Clause, None] = {}
        for member in group.writers(slots, causes):
            if member.state == GATHERING or (
                member.state < RUNNING and not causes.helpful.isdisjoint(member.clause.rule.raises)
            ):
                found[member.clause] = None
        for rule in group.causers(slots, causes):
            found.update(dict.fromkeys(causes.downstream(rule)))
        for spike in group.entries:
            for half in state.halves_of(spike):
                found.update(dict.fromkeys([need.clause for need in half.best if state.keeps(need, spike)]))
        for clause in found:
            if clause.rule.slotset.isdisjoint(first.rule.slotset) or state.standing.is_ahead(clause, first):
                continue
            if state.standing.recovery(clause)[1]:
                leader.recovering.append(clause)
            elif leader.next is None or state.standing.is_ahead(clause, leader.next):
                leader.next = clause
        leader.known = True
