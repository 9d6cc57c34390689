"""The relations between the records of a policy: listeners, coherent needs, contests."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from ravestate.policy.causes import Causes
from ravestate.policy.model import Clause, Need, RulePlan, SignalPlan, SlotPlan


def connect(signals: Sequence[SignalPlan], slots: Iterable[SlotPlan], rules: Iterable[RulePlan]) -> None:
    """Set the listeners and watchers of each signal, and mark the signals that are inputs (L8)."""
    raised = {signal for rule in rules for signal in rule.raises}
    listeners: list[list[Need]] = [[] for _ in signals]
    watchers: list[list[Need]] = [[] for _ in signals]
    for rule in rules:
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

    Needs are kin if their pathways share a signal.
    """
    for rule in rules:
        for clause in rule.clauses:
            families: list[tuple[int, int]] = []  # the roots and the needs of each group of kin, as bits
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


def find_contests(signals: Sequence[SignalPlan], causes: Causes) -> None:
    """Set the contests of each signal: the clauses that compete for each of its spikes, in a fixed order.

    One spike of the signal makes such a clause ready. The clauses write the same slots, and their order never changes.
    Only the first clause can get consent, unless it resigns or fails. Until it has done so, the engine makes no
    activation of the other clauses (``engine/conflict_sets.py``). A clause takes no part if its effects may help a rule
    that writes a slot. Other activations may have to wait for such effects (L16), so this clause needs an activation.
    """
    helpful = causes.leading_to_slots()
    for signal in signals:
        contests: dict[tuple[frozenset[int], bool], list[Clause]] = {}
        for need in signal.listeners:
            clause, rule = need.clause, need.clause.rule
            fixed = not (need.detached or clause.cyclic or rule.cooldown)
            if clause.simple and rule.slots and fixed and helpful.isdisjoint(rule.raises):
                contests.setdefault((rule.slotset, rule.background), []).append(clause)
        signal.contests = tuple(
            tuple(sorted(clauses, key=lambda c: (-c.base, c.index)))
            for clauses in contests.values()
            if len(clauses) > 1
        )
        contested = {clause for clauses in signal.contests for clause in clauses}
        signal.uncontested = tuple(need for need in signal.listeners if need.clause not in contested)
