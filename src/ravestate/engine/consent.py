"""Consent (L15): whether a ready activation may run now, and if not, which activations it waits for.

A group refuses while one of the activation's slots is taken in it, or while there is a rival: another viable clause
that writes one of these slots, has greater effective utility, and has a stake in the group. A clause has a stake if
it holds a spike of the group, or lacks a signal that a rule of the group may cause.

A rival that may never become ready is under pressure: it has its patience, once in each group (L16).
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping
from typing import TYPE_CHECKING

from ravestate.engine.activation import NEVER, RUNNING, Activation
from ravestate.engine.horizon import FIRM, NO, Horizon
from ravestate.policy.model import Clause, Half, RulePlan

if TYPE_CHECKING:
    from ravestate.engine.agenda import Agenda as Engine
    from ravestate.engine.group import Group
    from ravestate.engine.spike import Spike


class Refusal:
    """The reasons for which an activation must wait. If `names` is empty, the activation has consent.

    Attributes:
        names: The names of the rules that the activation waits for.
        blockers: The live activations on whose progress the refusal depends.
        firm: For each rival that will be ready, or fail, by work in progress: the activations at work.
        taken: Whether a slot is taken.
        pressed: Whether a rival may never be ready, so that only its patience ends the wait.
        hopes: Things outside its groups on which the refusal depends (`Horizon.hopes`).
        interests: The groups whose changes may lift the refusal.
        recheck: The earliest time at which recovering utilities, or the age of a spike, may lift it (seconds).
    """

    __slots__ = ("blockers", "firm", "hopes", "interests", "names", "pressed", "recheck", "taken")

    def __init__(self) -> None:
        self.interests: dict[Group, None] = {}
        self.hopes: Mapping[tuple[int, int], int] = {}
        self.names: dict[str, None] = {}
        self.blockers: dict[Activation, None] = {}
        self.firm: list[tuple[Activation, ...]] = []
        self.taken = self.pressed = False
        self.recheck = NEVER

    @classmethod
    def by(cls, holder: Activation, activation: Activation) -> Refusal:
        """Return the refusal of `activation` because `holder` runs and excludes it."""
        refusal = cls()
        refusal.names[holder.clause.rule.name] = None
        refusal.blockers[holder] = None
        refusal.taken = True
        refusal.interests = dict.fromkeys(activation.firm_groups())
        return refusal

    def __bool__(self) -> bool:
        return bool(self.names)


def ask(
    engine: Engine, activation: Activation, without: Collection[Activation] = (), *, commit: bool = True
) -> Refusal:
    """Ask every causal group of a ready activation for consent, and return the refusal; an empty refusal is consent.

    Args:
        engine: The engine.
        activation: The activation.
        without: Activations that count as doing nothing.
        commit: Whether rivals come under pressure, and give up when their patience is over.
    """
    refusal = Refusal()
    eliminated = False
    clause = activation.clause
    rule = clause.rule
    slots = rule.slotset
    groups = activation.firm_groups()
    refusal.interests = dict.fromkeys(groups)
    standing = engine.standing
    horizon: Horizon | None = None
    for group in groups:
        for slot in rule.slots:
            for holder in group.taken.get(slot) or ():
                refusal.taken = True
                refusal.names[holder.clause.rule.name] = None
                refusal.blockers[holder] = None
        if not group.taken.keys().isdisjoint(slots):
            continue
        for half, spike in _rival_halves(engine, group, slots) if group.entries else ():
            if clause.rule.cooldown:
                engine.unfold_half(spike, half)
                continue
            best = _best(engine, half, spike, clause)
            if best is None or not standing.refuses(best.clause, clause):
                continue
            if horizon is None:
                horizon = _horizon(engine, activation, without)
            strength, roots = horizon.judge(best.clause, best, group)
            if (
                horizon.judge(best.clause, None, group)[0] != NO
                or horizon.open_bits(best.clause, group)
                or (strength != NO and (strength != FIRM or best.clause.rule.index in engine.active))
            ):
                engine.unfold_half(spike, half)  # its rivals must be pressed, or compared, one by one
                horizon.renew()
            elif strength == FIRM:
                refusal.blockers.update(dict.fromkeys(roots))
                refusal.firm.append(roots)
                refusal.names[best.clause.rule.name] = None
        for rival, members in _rivals(engine, activation, group):
            if clause.rule.cooldown or rival.rule.cooldown:
                refusal.recheck = min(refusal.recheck, standing.crossing(clause, rival))
            if not standing.refuses(rival, clause):
                continue
            if horizon is None:
                horizon = _horizon(engine, activation, without)
            apart = 0  # how many of its activations wait for the group's signals without a spike of the group
            sure: list[Activation] = []
            for member in (*members, *horizon.elsewhere(rival, group), None):
                if member is None and apart:
                    break  # the older activation takes the signal
                if member is not None and (
                    member.state >= RUNNING or member in horizon.still or any(_covers(older, member) for older in sure)
                ):
                    continue
                strength, roots = horizon.judge(rival, member, group)
                if strength == NO:
                    continue
                if strength == FIRM:
                    refusal.blockers.update(dict.fromkeys(roots))
                    refusal.firm.append(roots)
                    if member is not None:
                        sure.append(member)
                elif engine.press(rival, member, group, activation, commit=commit) > engine.now:
                    refusal.pressed = True
                else:
                    if commit and member is not None:
                        horizon.forget(member)
                        engine.eliminate(member)
                        eliminated = True
                    continue
                apart += member is not None and member not in group.members
                refusal.names[rival.rule.name] = None
    if eliminated and refusal:
        return ask(engine, activation, without)  # rivals judged before may have hung on the eliminated one
    if horizon is not None:
        refusal.interests.update(horizon.visited)
        refusal.hopes = horizon.hopes
        refusal.recheck = min(refusal.recheck, horizon.recheck)
    return refusal


def _rival_halves(engine: Engine, group: Group, slots: frozenset[int]) -> list[tuple[Half, Spike]]:
    """Return the halves that hold spikes of the group for clauses that write one of the slots, with these spikes."""
    return [(h, spike) for spike in group.entries for h in engine.halves_of(spike) if not h.slotset.isdisjoint(slots)]


def _best(engine: Engine, half: Half, spike: Spike, clause: Clause) -> Activation | None:
    """Return the activation that the best other clause would have for an entry; it stands for all (`Half`)."""
    for need in half.best:
        if need.clause is not clause and engine.keeps(need, spike):
            best = Activation(0, need.clause)
            best.spikes[need.index] = spike
            best.missing &= ~need.bit
            return best
    return None


def _horizon(engine: Engine, activation: Activation, without: Collection[Activation]) -> Horizon:
    return Horizon(engine, {activation, *without, *_kept(engine, activation)})


def _kept(engine: Engine, activation: Activation) -> Iterator[Activation]:
    """Yield the activations that wait, or would wait, because of `activation` (L16)."""
    clause = activation.clause
    slots = clause.rule.slotset
    for group in activation.firm_groups():
        for other in group.members:
            theirs = other.clause
            if (
                theirs is not clause
                and other.state < RUNNING
                and not theirs.rule.slotset.isdisjoint(slots)
                and engine.standing.overtakes(clause, theirs)
            ):
                yield other


def _rivals(engine: Engine, activation: Activation, group: Group) -> list[tuple[Clause, list[Activation]]]:
    """Return the clauses that may write one of the activation's slots for the group, in declaration order, each with
    its activations there."""
    clause = activation.clause
    slots = clause.rule.slotset
    worth = engine.standing.effective(clause)
    found: dict[Clause, list[Activation]] = {}
    rules: dict[RulePlan, None] = {}
    for member in group.members:
        theirs = member.clause
        rules[theirs.rule] = None
        if theirs is not clause and not theirs.rule.slotset.isdisjoint(slots):
            found.setdefault(theirs, []).append(member)
    for rule in rules:
        for theirs in engine.policy.causes.downstream(rule):
            if theirs.base < worth:
                break  # the best clauses come first, and a cooldown only lowers a utility
            if theirs is not clause and not theirs.rule.slotset.isdisjoint(slots):
                found.setdefault(theirs, [])
    return sorted(found.items(), key=_place)


def _covers(older: Activation, younger: Activation) -> bool:
    """Return whether an older activation, which is still to run, holds all the spikes of a younger one."""
    return all(spike in older.spikes for spike in younger.firm_spikes())


def _place(rival: tuple[Clause, list[Activation]]) -> int:
    return rival[0].index


def stalemate(engine: Engine, refused: Iterable[Activation], known: Collection[Activation] = ()) -> set[Activation]:
    """Return activations that wait for nothing but each other.

    Two ready rules may each wait for a rival that the other might bring about. They would wait for ever, so the one
    with the greater effective utility goes first, or else the one declared first.

    Args:
        engine: The engine.
        refused: The activations that were refused since the last search: at least one is in any new stalemate.
        known: The activations that earlier searches found.
    """
    waiting = engine.waiting.keys()
    seen: set[Activation] = set()
    reached = list(refused)
    while True:
        while reached:
            one = reached.pop()
            if one in seen or one not in waiting or not one.firm or one.bounded:
                continue
            if any(waiting.isdisjoint(roots) for roots in one.firm):
                continue  # it waits for work that waits for nothing
            seen.add(one)
            for roots in one.firm:
                reached += roots
        if not seen:
            return seen
        stuck = set(seen)
        while freed := {one for one in stuck if any(stuck.isdisjoint(roots) for roots in one.firm)}:
            stuck -= freed
        while stuck:
            without = stuck.union(known)
            answers = [(one, ask(engine, one, without, commit=False)) for one in stuck]
            freed = [(one, refusal) for one, refusal in answers if refusal]
            if not freed:
                break
            stuck -= {one for one, _ in freed}
            for _, refusal in freed:  # it waits for others as well, and these may wait for it
                reached += [root for roots in refusal.firm for root in roots if root not in seen]
        if not any(root in engine.waiting and root.firm and not root.bounded for root in reached):
            return stuck
