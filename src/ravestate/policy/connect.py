"""The relations between the records of a policy.

A *need* is one constraint of a clause. The functions find the needs that listen to each signal, needs that are kin,
clauses without rivals, conflict sets, and halves. They explain these terms.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

from ravestate.policy.causes import Causes
from ravestate.policy.model import Clause, Half, Need, RulePlan, SignalPlan, SlotPlan


def connect(signals: Sequence[SignalPlan], slots: Iterable[SlotPlan], rules: Iterable[RulePlan]) -> None:
    """Set the fields of signals and slots that depend on the conditions and effects of all rules.

    Signals: `listeners` and `watchers` (the needs for the signal in conditions and in `until` conditions), `retain`,
    and `input` (law L8). Slots: `guarded` and `heard`.
    """
    raised = {signal for rule in rules for signal in rule.raises}
    listeners: list[list[Need]] = [[] for _ in signals]
    watchers: list[list[Need]] = [[] for _ in signals]
    for rule in rules:
        for clause in (*rule.clauses, *rule.until):
            for slot, _ in clause.guards:
                slot.guarded = True
        for clause in rule.clauses:
            for need in clause.needs:
                listeners[need.signal.index].append(need)
                if need.detached and clause.asks_detached:
                    need.signal.retain = max(need.signal.retain, need.max_age)
        for clause in rule.until:
            for need in clause.needs:
                watchers[need.signal.index].append(need)
    for signal in signals:
        signal.listeners = tuple(listeners[signal.index])
        signal.watchers = tuple(watchers[signal.index])
        signal.input = signal.input or signal.index not in raised
    for slot in slots:
        slot.heard = any(signal.listeners or signal.watchers for signal in slot.signals)


def find_kin(rules: Iterable[RulePlan], causes: Causes) -> None:
    """Set the kin of each need: the needs of its clause that must hold spikes of the same causal group (L12).

    Non-detached needs are kin if their pathways share a signal, or if their signals belong to one slot. Kin of kin are
    kin, too. Pathways share a signal if they share a *root*, a signal or cycle where they begin (`Causes.roots`).
    """
    for rule in rules:
        for clause in rule.clauses:
            families: list[tuple[int, int]] = []  # for each family of kin: its roots and its needs, as bits
            for need in clause.needs:
                if need.detached:
                    continue
                roots, kin = causes.roots(need.signal.index), need.bit
                if need.signal.slot is not None:  # the signals of a slot cohere: they may come from one write
                    roots |= 1 << (len(causes.signals) + need.signal.slot)
                apart: list[tuple[int, int]] = []
                for others in families:
                    if others[0] & roots:
                        roots, kin = roots | others[0], kin | others[1]
                    else:
                        apart.append(others)
                families = [*apart, (roots, kin)]
            for need in clause.needs:
                need.kin = next((kin for _, kin in families if kin & need.bit), need.bit)
            clause.apart = len(families) == 1


def find_unrivalled(rules: Iterable[RulePlan]) -> None:
    """Mark each clause that always goes before all other clauses that write one of its slots.

    The utility of a rule with a cooldown changes over time. So a clause is not marked if it writes a slot that such a
    rule writes.
    """
    best: dict[int, Clause] = {}
    changing: set[int] = set()
    for rule in rules:
        for slot in rule.slots:
            if rule.cooldown:
                changing.add(slot)
            for clause in rule.clauses:
                other = best.setdefault(slot, clause)
                if (-clause.base, clause.index) < (-other.base, other.index):
                    best[slot] = clause
    for clause in best.values():
        slots = clause.rule.slots
        clause.unrivalled = changing.isdisjoint(slots) and all(best[slot] is clause for slot in slots)


def find_conflict_sets(signals: Sequence[SignalPlan], causes: Causes) -> None:
    """Set the conflict sets of each signal. The clauses of a conflict set compete for each spike of the signal.

    One spike of the signal makes such a clause ready. The clauses write the same slots, and their order never changes.
    So the first clause goes before the others. The engine needs an activation of the next clause only if the run of
    the first resigns, or fails before it writes (``engine/conflict_sets.py``).

    A signal is *helpful* if it leads to a rule that writes a slot, or to a slot predicate (`Causes.helpful`). A clause
    belongs to no conflict set if its rule may raise a helpful signal. Other activations wait as long as an activation
    may raise the signal that their rival lacks (L16). So such a clause always gets an activation of its own.
    """
    helpful = causes.helpful
    for signal in signals:
        sets: dict[tuple[frozenset[int], bool], list[Clause]] = {}
        for need in signal.listeners:
            clause, rule = need.clause, need.clause.rule
            fixed = not (need.detached or clause.cyclic or rule.cooldown)
            if clause.simple and rule.slots and fixed and helpful.isdisjoint(rule.raises):
                sets.setdefault((rule.slotset, rule.background), []).append(clause)
        signal.conflict_sets = tuple(
            tuple(sorted(clauses, key=lambda c: (-c.base, c.index))) for clauses in sets.values() if len(clauses) > 1
        )


def find_halves(signals: Sequence[SignalPlan], causes: Causes) -> None:
    """Set the halves of each signal, and its `others`: the listeners that are in no conflict set and in no half.

    A half collects needs for one signal that the engine can treat alike (`_likeness`), from plain clauses with two
    needs (`_is_plain`). A clause with only the first of its two spikes cannot run yet. So the engine keeps the first
    spikes in a table, without activations (``engine/halves.py``). A clause belongs to no half if its rule may raise a
    helpful signal; `find_conflict_sets` explains the reason.
    """
    helpful = causes.helpful
    best = _best_writers(causes)
    for signal in signals:
        competing = {clause for clauses in signal.conflict_sets for clause in clauses}
        halves: dict[Any, list[Need]] = {}
        for need in signal.listeners:
            if _is_plain(need.clause) and helpful.isdisjoint(need.clause.rule.raises):
                key = need if _is_sole(need.clause, best, causes) else _likeness(need, causes)
                halves.setdefault(key, []).append(need)
        signal.halves = tuple(Half(tuple(needs)) for needs in halves.values())
        for half in signal.halves:
            half.sole = _is_sole(half.needs[0].clause, best, causes)
        signal.others = tuple(n for n in signal.listeners if n.half is None and n.clause not in competing)


def _best_writers(causes: Causes) -> dict[tuple[int, int], Clause]:
    """Return, for each pair of a slot and a part of the policy, the best clause there that writes the slot.

    A part is a set of signals where pathways begin, and whose effects may share a causal group (`Causes.parts`). A
    clause is in each part from which it may take spikes.
    """
    best: dict[tuple[int, int], Clause] = {}
    for rule in causes.rules:
        for clause in rule.clauses if rule.slots else ():
            for part in causes.parts(clause):
                for slot in rule.slots:
                    other = best.setdefault((slot, part), clause)
                    if (-clause.base, clause.index) < (-other.base, other.index):
                        best[slot, part] = clause
    return best


def _is_sole(clause: Clause, best: dict[tuple[int, int], Clause], causes: Causes) -> bool:
    """Return whether a plain clause (`_is_plain`) is sole: see `Half.sole`."""
    slots = clause.rule.slots
    return (
        bool(slots)
        and not clause.apart
        and not any(causes.causes[need.signal.index] for need in clause.needs)
        and all(best[slot, part] is clause for slot in slots for part in causes.parts(clause))
    )


def _is_plain(clause: Clause) -> bool:
    """Return whether a clause is plain: the only one of its rule, and ready as soon as it has spikes of two signals.

    A plain clause is also neither cyclic nor reflexive (`Clause`), and its rule has no cooldown.
    """
    rule = clause.rule
    return (
        len(clause.needs) == 2
        and len(rule.clauses) == 1
        and clause.needs[0].signal is not clause.needs[1].signal
        and not (clause.guards or clause.cyclic or clause.reflexive or rule.cooldown)
        and not any(need.detached or need.min_age for need in clause.needs)
    )


def _likeness(need: Need, causes: Causes) -> Any:
    """Return a key. If two needs for one signal have equal keys, the engine treats a first spike alike for both."""
    rule = need.clause.rule
    if need.predicates:
        return need
    other = need.clause.needs[1 - need.index].signal
    return (
        need.max_age,
        need.kin == need.bit,
        rule.slotset,
        rule.background,
        rule.patience,
        other.input,
        tuple(cause.index for cause in causes.causes[other.index]),
        tuple(cause.index for cause in causes.all_causes[other.index]),
    )
