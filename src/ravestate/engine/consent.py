"""Consent (law L15): whether a ready activation may run now, and if not, which activations it waits for.

The activation asks each causal group of its spikes. A group refuses while a run in the group has taken a slot that the
activation writes. It also refuses while the group has a *rival*: another clause that writes one of the activation's
slots, is ahead in effective utility, and may still become ready. An activation of the rival must hold a spike of the
group, or the rival must lack a signal that the group may cause.

If only an input or a rule of another group can make a rival ready, the rival is under *pressure*: it has a limited time
to become ready, its *patience*. When the patience ends, the activation stops waiting for the rival. Each activation of
a rival gets its patience once in each group (L16).

A clause without an activation may be a rival, too. A *half* (``halves.py``) keeps first spikes of pairs, without
activations, for such clauses. `_judge_half` judges these rivals. Each clause also has a *stand-by*, an activation that
holds no spike yet, and that may be a rival. While the engine has a tracer, halves hold no spikes, and `_judge_rival`
judges all rivals.
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Sequence
from typing import Any

from ravestate.engine import trace
from ravestate.engine.activation import CONSENT, NEVER, RUNNING, Activation, Refusal, by_age
from ravestate.engine.deadlines import PATIENCE
from ravestate.engine.group import NOTHING, Group
from ravestate.engine.halves import Halves
from ravestate.engine.holdings import Holdings
from ravestate.engine.horizon import NO, SURE, Horizon
from ravestate.engine.leaders import Leaders
from ravestate.engine.spike import Spike
from ravestate.engine.state import State
from ravestate.engine.stuck import Stuck
from ravestate.policy.model import Clause, Half, Need, RulePlan


class Consent:
    """The part of the engine that asks causal groups for consent, and puts rivals under pressure."""

    __slots__ = ("halves", "holdings", "leaders", "state")

    def __init__(self, state: State, holdings: Holdings, halves: Halves) -> None:
        self.state = state
        self.holdings = holdings
        self.halves = halves
        self.leaders = Leaders(state)

    def ask(self, activation: Activation, stuck: Sequence[Stuck] = (), *, commit: bool = True) -> Refusal:
        """Ask every causal group of a ready activation for consent. Return the refusal; an empty refusal is consent.

        Args:
            activation: The activation.
            stuck: Activations that count as doing nothing, because they wait only for each other.
            commit: Whether to change rivals: start their patience, and eliminate rivals whose patience has ended.
        """
        clause = activation.clause
        groups = activation.firm_groups()
        if clause.unrivalled and not _is_taken(groups, clause.rule):
            return CONSENT
        asks = commit and not stuck
        if asks and self.leaders.found:
            following = self.leaders.refuse(activation)
            if following is not None:
                return following
        refusal = Refusal()
        standing = self.state.standing
        for group in groups:
            refusal.interests[group] = None
        horizon: Horizon | None = None
        # Rivals that are behind the activation now, but will be ahead of it in the next moment.
        soon: list[tuple[Clause, list[Activation], Group]] = []
        eliminated = False
        for group in groups:
            if (group.taken and _note_taken(refusal, group, clause.rule)) or clause.unrivalled:
                continue
            for half, spike in self._rival_halves(clause, group) if group.entries else ():
                if clause.rule.cooldown and not half.sole:
                    self.halves.unfold(spike, half)
                elif (best := self._best(half, spike, clause)) is not None:
                    horizon = horizon or self._horizon(activation, stuck)
                    if self._judge_half(refusal, horizon, best, spike, clause, commit=commit):
                        eliminated = True
            for rival, members in self._rivals(activation, group):
                if clause.rule.cooldown or rival.rule.cooldown:
                    refusal.recheck = min(refusal.recheck, standing.crossing(clause, rival))
                if standing.is_ahead(rival, clause):
                    horizon = horizon or self._horizon(activation, stuck)
                    if self._judge_rival(refusal, horizon, rival, members, group, activation, commit=commit):
                        eliminated = True
                elif rival.rule.cooldown and standing.overtakes(rival, clause):
                    soon.append((rival, members, group))
        for rival, members, group in soon if refusal.names else ():
            horizon = horizon or self._horizon(activation, stuck)
            if self._judge_rival(refusal, horizon, rival, members, group, activation, commit=commit):
                eliminated = True
        if eliminated and refusal.names:
            return self.ask(
                activation, stuck
            )  # the verdict on an earlier rival may have depended on the eliminated one
        if asks and refusal.names and not refusal.taken:
            self.leaders.add(activation)
        if horizon is not None:
            refusal.interests.update(horizon.visited)
            refusal.hopes = horizon.hopes
            refusal.recheck = min(refusal.recheck, horizon.recheck)
        return refusal

    def _judge_rival(
        self,
        refusal: Refusal,
        horizon: Horizon,
        rival: Clause,
        members: Sequence[Activation],
        group: Group,
        activation: Activation,
        *,
        commit: bool,
    ) -> bool:
        """Judge a rival in a group: its activations and its stand-by. Return whether an activation was eliminated.

        If the rival may still become ready, add it to `refusal`, which `ask` returns.
        """
        eliminated = False
        outside = False  # whether a viable activation of the rival holds no spike of the group, but waits for one
        sure: list[Activation] = []
        if self.state.halves and horizon.open_bits(rival, group):
            self.halves.unfold_clause(rival)
        living = [*members, *horizon.elsewhere(rival, group)]
        if len(living) > 1:
            living.sort(key=by_age)  # an older activation may cover younger ones (`_is_covered`)
        for member in (*living, None):
            if member is None:
                if outside:
                    break  # the activation outside would take the spike first, so the stand-by is no rival
            elif member.state >= RUNNING or horizon.is_inert(member) or _is_covered(member, sure):
                continue
            strength, roots = horizon.judge(rival, member, group)
            if strength == NO:
                continue
            if strength == SURE:
                _note_sure(refusal, roots)
                if member is not None:
                    sure.append(member)
            elif (until := self.press(rival, member, group, activation, commit=commit)) > self.state.now:
                if member is None:
                    refusal.recheck = min(refusal.recheck, until)
                refusal.in_doubt = True
            else:
                if commit and member is not None:
                    horizon.forget(member)
                    self.eliminate(member)
                    eliminated = True
                continue
            outside = outside or (member is not None and not group.has(member))
            refusal.name(rival)
        return eliminated

    def _judge_half(
        self, refusal: Refusal, horizon: Horizon, best: Need, spike: Spike, clause: Clause, *, commit: bool
    ) -> bool:
        """Judge the rivals among the clauses of a half that holds a spike. Return whether a clause was eliminated.

        Each clause lacks only a second spike. If all have the same prospects of getting it, the verdict on the best
        clause applies to all. Otherwise, the half unfolds: each clause gets an activation, which `ask` judges.

        If a clause may still become ready, add it to `refusal`, which `ask` returns.
        """
        rival, half, group = best.clause, best.half, spike.group.root()
        assert half is not None
        bench = self.state.bench_of(half, spike)
        if bench is not None and bench.partner is not None:  # the rival is ready
            _note_sure(refusal, tuple([one for one in bench.partner.holders if one.clause is rival]))
            refusal.name(rival)
            return False
        strength, roots = horizon.judge(rival, self.state.stand_in(best, spike), group)
        if (
            horizon.judge(rival, None, group)[0] != NO  # the clause's stand-by is a rival as well
            or horizon.open_bits(rival, group)  # activations in other groups may take a spike of this group
            or (strength == SURE and rival.rule.index in self.state.active)  # an older activation may cover the rival
            or (strength != NO and self._is_held_beside(half, spike))  # an older activation may cover the new one
            or (strength not in (NO, SURE) and not rival.needs[1 - best.index].signal.input)  # the prospects may differ
        ):
            self.halves.unfold(
                spike, half
            )  # the horizon stays valid: nothing that it has found depends on the new activations
        elif strength == SURE:
            _note_sure(refusal, roots)
            refusal.name(rival)
        elif strength != NO:
            return self._press_half(refusal, half, spike, clause, commit=commit)
        return False

    def _is_held_beside(self, half: Half, spike: Spike) -> bool:
        """Return whether some clause holds the spike twice: in the half, and in an activation."""
        for holder in spike.holders:
            rank = half.rank.get(holder.clause.index)
            if rank is not None and self.state.keeps(half.best[rank], spike):
                return True
        return False

    def _press_half(self, refusal: Refusal, half: Half, spike: Spike, clause: Clause, *, commit: bool) -> bool:
        """Put the clauses of a half that are ahead of `clause` under pressure. Return whether a clause was eliminated.

        For each spike and half, `State.patience_ends` has pairs of a count and a time. The count says how many of the
        half's best clauses are under pressure, including the clauses of earlier pairs. The time is the end of the
        patience of the clauses that the pair adds.

        If a clause still has patience, add it to `refusal`, which `ask` returns.
        """
        state = self.state
        pressed = state.patience_ends.get(spike, {}).get(half, [])
        ahead = bisect_left(half.ranks, (-clause.base, clause.index))
        if commit and (not pressed or pressed[-1][0] < ahead):
            until = state.now + (state.patience if half.patience is None else half.patience)
            if state.patience_ends is NOTHING:
                state.patience_ends = {}
            state.patience_ends.setdefault(spike, {}).setdefault(half, pressed).append((ahead, until))
        begin, eliminated = 0, False
        for count, until in list(pressed):
            end = min(count, ahead)
            if until > state.now:
                kept = [n.clause for n in half.best[begin:end] if state.keeps(n, spike)]
                for theirs in kept:
                    refusal.name(theirs)
                if kept:
                    refusal.in_doubt = True
                    refusal.recheck = min(refusal.recheck, until)
            elif commit and begin < end and self.holdings.entries.refuse_best(spike, half, begin, end):
                eliminated = True
            begin = count
        return eliminated

    def _best(self, half: Half, spike: Spike, clause: Clause) -> Need | None:
        """Return the need of the best rival of `clause` among the clauses for which a half holds a spike; None without
        a rival."""
        for need in half.best:
            if need.clause is not clause and self.state.keeps(need, spike):
                return need if self.state.standing.is_ahead(need.clause, clause) else None
        return None

    def is_contested(self, best: Activation) -> bool:
        """Return whether a rival may stand between the clauses of a conflict set in the order of utility.

        The clauses of a conflict set compete for each spike (``conflict_sets.py``). Only the best one has an
        activation; the others are its alternatives. A rival in between would wait for the best clause, and an
        alternative would wait for the rival.
        """
        state = self.state
        clauses = state.alternatives[best][0]
        first, last = best.clause, clauses[-1]
        slots = first.rule.slotset
        limit = (-last.base, last.index)
        for group in best.firm_groups():
            for half, _ in self._rival_halves(first, group) if group.entries else ():
                if bisect_left(half.ranks, (-first.base, first.index)) < bisect_left(half.ranks, limit):
                    return True
            rivals: dict[Clause, None] = {}
            for member in group.writers(first.rule.slots, state.causes):
                rivals[member.clause] = None
            for rule in group.causers(first.rule.slots, state.causes):
                for theirs in state.causes.downstream(rule):
                    if theirs.base < last.base:
                        break  # the best clauses come first
                    rivals[theirs] = None
            for theirs in rivals:
                if (
                    theirs is not first
                    and (-theirs.base, theirs.index) < limit
                    and not theirs.rule.slotset.isdisjoint(slots)
                    and not state.standing.is_ahead(theirs, first)
                ):
                    return True
        return False

    def press(
        self, rival: Clause, member: Activation | None, group: Group, by: Activation, *, commit: bool = True
    ) -> float:
        """Start a rival's patience in a group, unless it has started already.

        Return when the patience ends (seconds), or minus infinity if it has not started.

        Args:
            rival: The clause that is the rival.
            member: The rival's activation, or None for the rival's stand-by.
            group: The group.
            by: The activation that waits for the rival.
            commit: Whether to start the patience if it has not started yet (L16).
        """
        state = self.state
        table: dict[Any, float]
        key: Any
        if member is None:
            if group.patience_ends is None:
                group.patience_ends = {}
            table, key = group.patience_ends, rival.index
        else:
            if not member.patience_ends:
                member.patience_ends = {}
            table, key = member.patience_ends, group
        if key in table or not commit:
            return table.get(key, -NEVER)
        patience = rival.rule.patience
        until = table[key] = state.now + (state.patience if patience is None else patience)
        if until > state.now and member is not None:  # for a stand-by, `Refusal.recheck` keeps this time
            state.deadlines.add(until, PATIENCE, (group, member))
        if state.tracer is not None:
            missing = rival.all_bits if member is None else member.missing
            lacks = tuple([n.signal.name for n in rival.needs if n.bit & missing])
            state.tracer(trace.Pressed(state.now, rival.rule.name, by.clause.rule.name, lacks, until))
        return until

    def eliminate(self, rival: Activation) -> None:
        """End a rival whose patience has ended. The rival's rule gives the rival's spikes up for good (L16)."""
        for spike in rival.firm_spikes():
            # Unfold now: once the rule has given the spike up, an alternative of this rule cannot take it.
            for other in list(spike.holders) if self.state.alternatives else ():
                queue = self.state.alternatives.get(other)
                if queue is not None and any([clause.rule is rival.clause.rule for clause in queue[0]]):
                    self.halves.sets.unfold(other)
            self.holdings.entries.refuse_for_good(spike, rival.clause.rule)
        self.holdings.end(rival, "eliminated")

    def _horizon(self, activation: Activation, stuck: Sequence[Stuck]) -> Horizon:
        """Return the horizon for an activation that asks: the signals that may come while it does nothing (L16).

        Activations that wait for the asking activation, or would wait for it, do nothing either.
        """
        inert = {activation}
        clause = activation.clause
        slots = clause.rule.slotset
        for group in activation.firm_groups():
            for other in group.writers(clause.rule.slots, self.state.causes):
                theirs = other.clause
                if (
                    theirs is not clause
                    and other.state < RUNNING
                    and not theirs.rule.slotset.isdisjoint(slots)
                    and self.state.standing.overtakes(clause, theirs)
                ):
                    inert.add(other)
        return Horizon(self.state, inert, stuck)

    def _rival_halves(self, clause: Clause, group: Group) -> list[tuple[Half, Spike]]:
        """Return pairs of a half whose rules write a slot of `clause`, and a spike of the group that the half holds."""
        slots = clause.rule.slotset
        found: list[tuple[Half, Spike]] = []
        for spike in group.entries:
            found += [(half, spike) for half in self.state.halves_of(spike) if not half.slotset.isdisjoint(slots)]
        return found

    def _rivals(self, activation: Activation, group: Group) -> list[tuple[Clause, list[Activation]]]:
        """Return the possible rivals of an activation in a group, in declaration order, with their activations there.

        A clause without an activation in the group is left out if it has less utility than the activation's clause.
        """
        clause = activation.clause
        slots = clause.rule.slotset
        worth = self.state.standing.effective(clause)
        found: dict[Clause, list[Activation]] = {}
        causes = self.state.causes
        alone = group.count == 1  # the activation is the only member
        for member in () if alone else group.writers(clause.rule.slots, causes):
            theirs = member.clause
            if theirs is not clause and not theirs.rule.slotset.isdisjoint(slots):
                found.setdefault(theirs, []).append(member)
        for rule in (clause.rule,) if alone else group.causers(clause.rule.slots, causes):
            for theirs in causes.downstream(rule):
                if theirs.base < worth:
                    break  # the best clauses come first, and a cooldown only lowers a utility
                if theirs is not clause and not theirs.rule.slotset.isdisjoint(slots):
                    found.setdefault(theirs, [])
        return sorted(found.items(), key=lambda rival: rival[0].index)


def _is_taken(groups: Sequence[Group], rule: RulePlan) -> bool:
    """Return whether one of the rule's slots is taken in one of the groups."""
    for group in groups:
        for slot in rule.slots if group.taken else ():
            if slot in group.taken:
                return True
    return False


def _note_taken(refusal: Refusal, group: Group, rule: RulePlan) -> bool:
    """Return whether one of the rule's slots is taken in a group; record in the refusal which runs took it."""
    if group.taken.keys().isdisjoint(rule.slotset):
        return False
    for slot in rule.slots:
        for holder in group.taken.get(slot) or ():
            refusal.taken = True
            refusal.name(holder.clause)
            refusal.blockers[holder] = None
    return True


def _note_sure(refusal: Refusal, roots: tuple[Activation, ...]) -> None:
    """Record the activations whose progress decides whether a rival becomes ready."""
    for root in roots:
        refusal.blockers[root] = None
    refusal.sure.append(roots)


def _is_covered(younger: Activation, older: Sequence[Activation]) -> bool:
    """Return whether an older activation, which will be ready first, holds all spikes of a younger activation."""
    spikes = younger.firm_spikes() if older else ()
    return any([all([spike in one.spikes for spike in spikes]) for one in older])
