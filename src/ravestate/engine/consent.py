"""Consent (L15): whether a ready activation may run now, and if not, which activations it waits for.

A group refuses while one of the activation's slots is taken in it, or while there is a rival: another viable clause
that writes one of these slots, has greater effective utility, and has a stake in the group. A clause has a stake if
it holds a spike of the group, or if a live rule of the group may trigger it.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING

from ravestate.engine.activation import NEVER, RUNNING, Activation
from ravestate.engine.horizon import FIRM, NO, Horizon
from ravestate.policy.model import Clause, RulePlan

if TYPE_CHECKING:
    from ravestate.engine.agenda import Agenda as Engine
    from ravestate.engine.group import Group


class Refusal:
    """The reasons for which an activation must wait. If `names` is empty, the activation has consent.

    Attributes:
        names: The names of the rules that the activation waits for.
        blockers: The live activations on whose progress the refusal depends.
        pressed: (group, clause, activation or None) of each rival that may never be ready: its patience ends the wait.
        hopes: Whether the refusal depends on live rules of other groups.
        interests: The groups whose changes may lift the refusal.
        recheck: The earliest time at which recovering utilities change the order (seconds); `NEVER` if none does.
    """

    __slots__ = ("blockers", "hopes", "interests", "names", "pressed", "recheck")

    def __init__(self) -> None:
        self.interests: dict[Group, None] = {}
        self.hopes = False
        self.names: dict[str, None] = {}
        self.blockers: dict[Activation, None] = {}
        self.pressed: list[tuple[Group, Clause, Activation | None]] = []
        self.recheck = NEVER

    @classmethod
    def by(cls, holder: Activation, activation: Activation) -> Refusal:
        """Return the refusal of `activation` because `holder` runs and excludes it."""
        refusal = cls()
        refusal.names[holder.clause.rule.name] = None
        refusal.blockers[holder] = None
        refusal.interests = dict.fromkeys(activation.firm_groups())
        return refusal

    def __bool__(self) -> bool:
        return bool(self.names)


def ask(engine: Engine, activation: Activation) -> Refusal:
    """Ask every causal group of a ready activation for consent, and return the refusal; an empty refusal is consent."""
    refusal = Refusal()
    clause = activation.clause
    rule = clause.rule
    horizon: Horizon | None = None
    for group in activation.firm_groups():
        refusal.interests[group] = None
        taken = False
        for slot in rule.slots:
            for holder in group.taken.get(slot) or ():
                taken = True
                refusal.names[holder.clause.rule.name] = None
                refusal.blockers[holder] = None
        if taken:
            continue
        for member in list(group.members):
            if member in engine.alternatives and member is not activation:
                engine.unfold(member)
        for rival, member in _rivals(engine, activation, group):
            if horizon is None:
                horizon = engine.horizon()
            strength, roots = horizon.judge(rival, member, group)
            if strength == NO:
                continue
            refusal.names[rival.rule.name] = None
            if strength == FIRM:
                refusal.blockers.update(roots)
            else:
                refusal.pressed.append((group, rival, member))
            if clause.rule.cooldown or rival.rule.cooldown:
                refusal.recheck = min(refusal.recheck, _crossing(engine, clause, rival))
    if horizon is not None:
        refusal.interests.update(horizon.visited)
        refusal.hopes = horizon.hopes
    return refusal


def _rivals(engine: Engine, activation: Activation, group: Group) -> Iterator[tuple[Clause, Activation | None]]:
    """Yield the rivals of an activation in a group, each with its activation there, or None for one in stand-by."""
    clause = activation.clause
    slots = clause.rule.slotset
    worth = engine.effective(clause)
    seen: set[Clause] = {clause}
    rules: dict[RulePlan, None] = {}
    for member in tuple(group.members):  # a copy, because judging a rival may unfold alternatives
        theirs = member.clause
        rules[theirs.rule] = None
        if theirs is clause or theirs.rule.slotset.isdisjoint(slots) or member.state >= RUNNING:
            continue
        if _beats(engine, theirs, clause, worth):
            yield theirs, member
    for rule in rules:
        for theirs in engine.policy.causes.downstream(rule):
            if theirs.base < worth:
                break  # the best clauses come first, and a cooldown only lowers a utility
            if theirs in seen or theirs.rule.slotset.isdisjoint(slots):
                continue
            seen.add(theirs)
            if group.eliminated is not None and theirs.index in group.eliminated:
                continue
            if _beats(engine, theirs, clause, worth):
                yield theirs, None


def _beats(engine: Engine, theirs: Clause, mine: Clause, worth: float) -> bool:
    other = engine.effective(theirs)
    return other > worth or (other == worth and theirs.index < mine.index)


def _crossing(engine: Engine, mine: Clause, theirs: Clause) -> float:
    """Return the earliest time (seconds) at which `mine` may overtake `theirs`; both utilities climb linearly."""
    now = engine.now
    my_worth, my_slope, my_end = engine.recovery(mine)
    their_worth, their_slope, their_end = engine.recovery(theirs)
    turn = min(end for end in (my_end, their_end, NEVER) if end > now)
    closing = my_slope - their_slope
    if closing > 0:
        turn = min(turn, now + max(their_worth - my_worth, 0.0) / closing)
    return turn if turn > now else NEVER


def stalemate(engine: Engine, refused: Iterable[Activation]) -> Activation | None:
    """Return the best of the activations that wait only for each other, if there are any.

    Two ready rules may each wait for a rival that the other might bring about. They would wait for ever, so the one
    with the greater effective utility goes first, or else the one declared first.

    Args:
        engine: The engine.
        refused: The activations that were refused since the last search. A new stalemate contains at least one of
            them, and the chains of blockers lead from these activations to all of its members.
    """
    stuck: dict[Activation, None] = {}
    reached = [activation for activation in refused if activation in engine.waiting]
    while reached:
        activation = reached.pop()
        if activation not in stuck and activation in engine.waiting and not activation.speculative:
            stuck[activation] = None
            reached.extend(activation.blockers)
    while stuck:
        freed = [a for a in stuck if any(blocker not in stuck for blocker in a.blockers)]
        if not freed:
            break
        for activation in freed:
            del stuck[activation]
    return min(stuck, key=engine.order, default=None)
