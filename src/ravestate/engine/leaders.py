"""Leaders: a refused activation speaks for the activations behind it.

Suppose that a thousand fallbacks are ready, and the best fallback is refused. All others are refused as well, because
the best fallback is ahead of them. So only the best fallback, the *leader*, asks in full (``consent.py``). The others
*follow*: they wait for the leader, and look at no other rival.

A rival whose utility lies between those of the leader and another activation prevents this. The other activation
would put this rival under pressure, or expect help from it, but the leader did not (L16). So the other activation asks
in full, and leads the activations after it.

If a follower asked in full, it would also count on the effects of the leader. So an activation can lead only if its
effects help no rule that writes a slot.
"""

from __future__ import annotations

from ravestate.engine import roster
from ravestate.engine.activation import GATHERING, RUNNING, WAITING, Activation
from ravestate.engine.group import Group
from ravestate.engine.refusal import Refusal
from ravestate.engine.state import State
from ravestate.policy.model import Clause


class Leader:
    """A refused activation of one causal group.

    Attributes:
        activation: The activation.
        next: The best clause behind the activation that prevents others from following; None if there is none.
        recovering: More such clauses, of rules that recover. Their places in the order change with time.
    """

    __slots__ = ("activation", "known", "next", "recovering")

    def __init__(self, activation: Activation) -> None:
        self.activation = activation
        self.known = False  # whether the attributes below are known: they are computed for the first follower
        self.next: Clause | None = None
        self.recovering: list[Clause] = []


class Leaders:
    """The leaders of one round of questions; `found` maps a causal group and the slots asked for to the leader."""

    __slots__ = ("found", "state")

    def __init__(self, state: State) -> None:
        self.state = state
        self.found: dict[tuple[Group, frozenset[int]], Leader] = {}

    def add(self, activation: Activation) -> None:
        """Make a refused activation a leader, if it can be one."""
        groups, rule = activation.firm_groups(), activation.clause.rule
        if len(groups) == 1 and self.state.causes.helpful.isdisjoint(rule.raises):
            self.found[groups[0], rule.slotset] = Leader(activation)

    def refuse(self, activation: Activation) -> Refusal | None:
        """Return the refusal of an activation that follows a leader, or None if there is no such leader."""
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
        refusal.firm.append((leader.activation,))
        if clause.rule.cooldown or first.rule.cooldown or leader.recovering:
            refusal.recheck = min([standing.crossing(clause, theirs) for theirs in (first, *leader.recovering)])
        return refusal

    def _look_behind(self, leader: Leader, group: Group) -> None:
        """Find the clauses that prevent activations from following a leader."""
        state, first = self.state, leader.activation.clause
        causes, slots = state.causes, first.rule.slots
        found: dict[Clause, None] = {}
        for member in roster.writers(group, slots, causes):
            if member.state == GATHERING or (
                member.state < RUNNING and not causes.helpful.isdisjoint(member.clause.rule.raises)
            ):
                found[member.clause] = None
        for rule in roster.causers(group, slots, causes):
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
