"""The static graph of causes between signals (law L7), and its closures.

An edge leads from a signal, through a rule whose condition names it, to a signal that the rule raises. No edge leads
through a detached rule, because its effects have no causes. Nor does an edge lead through a detached constraint. The
closure of a signal holds the signal itself and all signals from which a path of edges leads to it.

A closure is stored as an integer, in which bit *n* stands for signal *n*. A closure over a thousand signals takes about
a hundred bytes, and intersecting two closures is fast.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence

from ravestate.policy.components import components
from ravestate.policy.model import Clause, Need, RulePlan, SignalPlan


class Causes:
    """The causes and closures of one policy. The closures are computed at their first use.

    Signals are given by their indices.

    Attributes:
        causes: Signal → the non-detached rules that may raise it.
        all_causes: Signal → all rules that may raise it.
        direct: Signal → the signals from which an edge leads to it.
        components: Sets of signals that lead to each other. A signal on no cycle is a component by itself.
    """

    def __init__(self, signals: Sequence[SignalPlan], rules: Sequence[RulePlan]) -> None:
        self.signals = signals
        self.rules = rules
        causes: list[list[RulePlan]] = [[] for _ in signals]
        all_causes: list[list[RulePlan]] = [[] for _ in signals]
        direct: list[dict[int, None]] = [{} for _ in signals]
        for rule in rules:
            firm = dict.fromkeys(need.signal.index for need in _needs(rule) if not need.detached)
            for signal in rule.raises:
                all_causes[signal].append(rule)
                if not rule.detached:
                    causes[signal].append(rule)
                    direct[signal].update(firm)
        self.causes = causes
        self.all_causes = all_causes
        self.direct = [tuple(found) for found in direct]
        self.components = components(self.direct)
        self._roots = self._find_roots()
        self._closures: list[int] | None = None  # the closure of each component
        self._ancestors: dict[int, frozenset[int]] = {}
        self._wide: dict[int, frozenset[int]] = {}
        self._downstream: dict[int, tuple[Clause, ...]] = {}
        self._behind: dict[int, frozenset[int]] = {}
        self._parts: list[int] | None = None  # root → the first root of its part (`parts`)
        self._contested: frozenset[int] | None = None
        self._helpful: frozenset[int] | None = None

    def roots(self, signal: int) -> int:
        """Return the roots of a signal's pathways, as bits: bit *n* stands for root *n*, not for signal *n*.

        A root is a signal without causes, or a cycle without causes outside the cycle. The pathways of two signals have
        a signal in common if and only if the two signals share a root.
        """
        return self._roots[self.components.of[signal]]

    def parts(self, clause: Clause) -> frozenset[int]:
        """Return the numbers of the *parts* of the policy from which a clause may take spikes.

        A part is a set of roots. Two roots are in one part if spikes that stem from them may share a causal group: one
        run may take spikes of both, or one write of a slot may raise both (L11, L12).
        """
        if self._parts is None:
            self._parts = self._find_parts()
        return frozenset([self._parts[root] for root in self._roots_of(_firm(clause))])

    def _roots_of(self, signals: Iterable[int]) -> list[int]:
        bits = 0
        for signal in signals:
            bits |= self.roots(signal)
        found: list[int] = []
        while bits:
            found.append(bits.bit_length() - 1)
            bits ^= 1 << found[-1]
        return found

    def _find_parts(self) -> list[int]:
        """Return, for each root, the first root of its part (by union-find)."""
        above = list(range(max([roots.bit_length() for roots in self._roots], default=0)))

        def first(root: int) -> int:
            while above[root] != root:
                above[root] = above[above[root]]
                root = above[root]
            return root

        raisers = [rule for rule in self.rules if rule.raises and not rule.detached]
        joins = [_firm(clause) for rule in raisers for clause in rule.clauses if not clause.apart]
        writes: dict[int, list[int]] = {}
        for signal in self.signals:
            if signal.slot is not None and not self.direct[signal.index]:
                writes.setdefault(signal.slot, []).append(signal.index)
        for signals in [signals for signals in (*joins, *writes.values()) if len(signals) > 1]:
            roots = self._roots_of(signals)
            for root in roots[1:]:
                one, other = first(roots[0]), first(root)
                above[max(one, other)] = min(one, other)
        return [first(root) for root in range(len(above))]

    def _find_roots(self) -> list[int]:
        of = self.components.of
        found: list[int] = []
        count = 0
        for number, members in enumerate(self.components.members):
            roots = 0
            for member in members:
                for cause in self.direct[member]:
                    if of[cause] != number:
                        roots |= found[of[cause]]
            if not roots:
                roots = 1 << count
                count += 1
            found.append(roots)
        return found

    def closure(self, signal: int) -> int:
        """Return the closure of a signal, as bits: all signals on its pathways."""
        if self._closures is None:
            self._closures = self._find_closures()
        return self._closures[self.components.of[signal]]

    def _find_closures(self) -> list[int]:
        """Return the closure of each component. All signals of a component have the same closure."""
        of = self.components.of
        found: list[int] = []
        for number, members in enumerate(self.components.members):  # causes before their effects
            bits = 0
            for member in members:
                bits |= 1 << member
                for cause in self.direct[member]:
                    if of[cause] != number:
                        bits |= found[of[cause]]
            found.append(bits)
        return found

    def ancestors(self, signal: int) -> frozenset[int]:
        """Return the indices of the rules from which a chain of effects leads to the signal.

        Chains through detached rules or constraints do not count.
        """
        component = self.components.of[signal]  # all signals of a component have the same ancestors
        if component not in self._ancestors:
            self._ancestors[component] = self._climb(signal, self.causes, wide=False)
        return self._ancestors[component]

    def wide_ancestors(self, signal: int) -> frozenset[int]:
        """Return the indices of the rules from which a chain of effects, detached or not, leads to the signal.

        A chain does not pass through an input, because an input may occur at any time anyway.
        """
        if signal not in self._wide:
            self._wide[signal] = self._climb(signal, self.all_causes, wide=True)
        return self._wide[signal]

    def _climb(self, signal: int, causes: Sequence[Sequence[RulePlan]], *, wide: bool) -> frozenset[int]:
        rules: set[int] = set()
        seen = {signal}
        stack = [signal]
        while stack:
            for rule in causes[stack.pop()]:
                if rule.index in rules:
                    continue
                rules.add(rule.index)
                for need in _needs(rule):
                    cause = need.signal
                    if (wide and cause.input) or (need.detached and not wide) or cause.index in seen:
                        continue
                    seen.add(cause.index)
                    stack.append(cause.index)
        return frozenset(rules)

    @property
    def helpful(self) -> frozenset[int]:
        """The signals from which a chain of effects leads to a rule that writes a slot, or to a predicate on a slot."""
        if self._helpful is None:
            self._helpful = self._find_helpful()
        return self._helpful

    def _find_helpful(self) -> frozenset[int]:
        found = {s.index for r in self.rules for c in r.clauses for slot, _ in c.guards for s in slot.signals}
        rules = [rule for rule in self.rules if rule.slots or not found.isdisjoint(rule.raises)]
        seen = set(rules)
        for rule in rules:  # the loop also visits the rules that its body appends
            for signal in {need.signal.index for need in _needs(rule)} - found:
                found.add(signal)
                more = [cause for cause in self.all_causes[signal] if cause not in seen]
                rules += more
                seen.update(more)
        return frozenset(found)

    def downstream(self, rule: RulePlan) -> tuple[Clause, ...]:
        """Return the clauses that may take a spike that `rule` causes, directly or through other rules.

        The spike must be in the causal group of `rule`'s run, and the clause's rule must write a slot. The clause with
        the greatest base utility comes first.
        """
        found = self._downstream.get(rule.index)
        if found is None:
            clauses: dict[Clause, None] = {}
            seen: set[int] = set()
            stack = [] if rule.detached else list(rule.raises)
            while stack:
                signal = stack.pop()
                if signal in seen:
                    continue
                seen.add(signal)
                for need in self.signals[signal].listeners:
                    if need.detached:
                        continue
                    if need.clause.rule.slots:
                        clauses[need.clause] = None
                    if not need.clause.rule.detached:
                        stack.extend(need.clause.rule.raises)
            found = self._downstream[rule.index] = tuple(sorted(clauses, key=lambda c: (-c.base, c.index)))
        return found

    def slots_behind(self, rule: RulePlan) -> frozenset[int]:
        """Return the slots that the rules of the `downstream` clauses write."""
        found = self._behind.get(rule.index)
        if found is None:
            slots = [slot for clause in self.downstream(rule) for slot in clause.rule.slots]
            found = self._behind[rule.index] = frozenset(slots)
        return found

    @property
    def contested(self) -> frozenset[int]:
        """The slots whose writes a search along a chain of effects must note.

        Such a search looks for a chain that writes each slot at most once, because a causal group allows no second
        write (L19).

        A slot that several rules write is contested. If only one rule writes a slot, a chain that writes the slot twice
        visits this rule twice. Within one group, the chain can leave out the part between the two visits, and still
        reaches the same end. So this slot is contested only if its rule is on a cycle with a clause that joins groups.
        """
        if self._contested is None:
            self._contested = self._find_contested()
        return self._contested

    def _find_contested(self) -> frozenset[int]:
        firm = [rule for rule in self.rules if not rule.detached]
        edges: list[dict[int, None]] = [{} for _ in self.signals]
        for rule in firm:
            for signal in rule.raises:
                edges[signal].update(dict.fromkeys(_watched(rule)))
        of = components([tuple(found) for found in edges]).of
        cycles = {r.index: {of[s] for s in _watched(r)} & {of[s] for s in r.raises} for r in firm}
        joined: set[int] = set()
        for rule in firm:
            if any(not clause.apart and clause.firm_bits.bit_count() > 1 for clause in rule.clauses):
                joined |= cycles[rule.index]
        writers = Counter(slot for rule in firm for slot in rule.slots)
        return frozenset(
            slot
            for rule in firm
            for slot in rule.slots
            if writers[slot] > 1 or not joined.isdisjoint(cycles[rule.index])
        )

    def grounded(self, given: Iterable[int]) -> frozenset[int]:
        """Return the signals that can ever occur if the signals in `given` can: a least fixed point over all rules."""
        reached = set(given)
        lacking = {clause: {n.signal.index for n in clause.needs} - reached for r in self.rules for clause in r.clauses}
        waiting: dict[int, list[Clause]] = {}
        ready: list[Clause] = []
        for clause, signals in lacking.items():
            if not signals:
                ready.append(clause)
            for signal in signals:
                waiting.setdefault(signal, []).append(clause)
        while ready:
            for signal in ready.pop().rule.raises:
                if signal not in reached:
                    reached.add(signal)
                    for clause in waiting.get(signal, ()):
                        lacking[clause].discard(signal)
                        if not lacking[clause]:
                            ready.append(clause)
        return frozenset(reached)


def _needs(rule: RulePlan) -> list[Need]:
    return [need for clause in rule.clauses for need in clause.needs]


def _firm(clause: Clause) -> list[int]:
    return [need.signal.index for need in clause.needs if not need.detached]


def _watched(rule: RulePlan) -> list[int]:
    """Return the signals in a rule's constraints, and the signals of the slots in its predicates."""
    slots = [slot for clause in rule.clauses for slot, _ in clause.guards]
    return [need.signal.index for need in _needs(rule)] + [signal.index for slot in slots for signal in slot.signals]
