"""Causal completion and utility (L8, L9; paper, Causal Pathway Utility).

The pathway of a clause is the clause plus, recursively, the causes of its non-detached constraints,
cycles cut. A signal with several causes gives several pathways. How many rules have a signal on *any*
pathway is a plain reachability question and is answered without enumerating pathways; only the least
sum wants them enumerated, and there the cheapest `MAX_PATHWAYS` of each signal are carried on.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

from ravestate.policy.causes import Causes
from ravestate.policy.plan import NO_INFORMATION, Clause, RulePlan, SignalPlan

__all__ = ["MAX_PATHWAYS", "PREDICATE", "assign_utilities"]

MAX_PATHWAYS = 256
"""Pathways of one signal that are carried on, the cheapest first."""

PREDICATE = math.log(2)
"""Nats that a ``where`` or ``holds`` predicate adds: it halves the prior (L9)."""

Pathway = frozenset[int]


def assign_utilities(signals: Sequence[SignalPlan], rules: Sequence[RulePlan], causes: Causes) -> None:
    """Give every clause its pathways, its utility and its base, and mark cyclic clauses."""
    cause_signals = _cause_signals(signals, causes)
    closure: dict[int, frozenset[int]] = {}

    def closed(signal: int) -> frozenset[int]:
        found = closure.get(signal)
        if found is None:
            seen = {signal}
            stack = [signal]
            while stack:
                for conjunction in cause_signals[stack.pop()]:
                    for cause in conjunction:
                        if cause not in seen:
                            seen.add(cause)
                            stack.append(cause)
            found = closure[signal] = frozenset(seen)
        return found

    counts = [0] * len(signals)
    for rule in rules:
        touched: set[int] = set()
        for clause in rule.clauses:
            for need in clause.needs:
                if need.detached:
                    touched.add(need.signal.index)
                else:
                    touched |= closed(need.signal.index)
        for signal in touched:
            counts[signal] += 1
        raised = set(rule.raises)
        for clause in rule.clauses:
            clause.cyclic = not rule.detached and any(
                not need.detached and not raised.isdisjoint(closed(need.signal.index))
                for need in clause.needs
            )
    information = [-math.log(n / len(rules)) if n else 0.0 for n in counts]
    completion = _Completion(cause_signals, information, closed)
    for signal in sorted(
        signals, key=lambda s: len(closed(s.index))
    ):  # causes first: keeps recursion shallow
        completion.pathways(signal.index, frozenset())
    for rule in rules:
        for clause in rule.clauses:
            _complete(clause, completion, information, signals)
            clause.base = (clause.utility or NO_INFORMATION) * rule.weight


def _complete(
    clause: Clause, completion: _Completion, information: Sequence[float], signals: Sequence[SignalPlan]
) -> None:
    found: list[Pathway] = [frozenset()]
    for need in clause.needs:
        if need.detached:
            found = [pathway | {need.signal.index} for pathway in found]
        else:
            found = completion.product(found, completion.pathways(need.signal.index, frozenset()))
    predicates = len(clause.guards) + sum(len(need.predicates) for need in clause.needs)
    cost = {pathway: math.fsum(information[s] for s in pathway) for pathway in found}
    found.sort(key=lambda pathway: (cost[pathway], sorted(pathway)))
    # Rounded, so that equal information compares equal whatever the order of summation.
    clause.utility = round(cost[found[0]] + predicates * PREDICATE, 12) + 0.0
    clause.pathways = tuple(frozenset(signals[s].signal for s in pathway) for pathway in found)


def _cause_signals(signals: Sequence[SignalPlan], causes: Causes) -> list[list[frozenset[int]]]:
    """For each signal the conjunctions of signals that cause it; an empty one stands for the bare pathway."""
    found: list[list[frozenset[int]]] = []
    for signal in signals:
        conjunctions = [
            frozenset(need.signal.index for need in clause.needs if not need.detached)
            for rule in causes.causes[signal.index]
            for clause in rule.clauses
        ]
        if signal.input or not conjunctions:
            conjunctions.insert(0, frozenset())
        found.append(list(dict.fromkeys(conjunctions)))
    return found


class _Completion:
    """The pathways of single signals, remembered by (signal, what of its own cycle is already on the way)."""

    def __init__(
        self,
        cause_signals: list[list[frozenset[int]]],
        information: list[float],
        closed: Callable[[int], frozenset[int]],
    ) -> None:
        self.cause_signals = cause_signals
        self.information = information
        self.closed = closed
        self.known: dict[tuple[int, frozenset[int]], list[Pathway]] = {}
        self.cycles: dict[int, frozenset[int]] = {}

    def cycle(self, signal: int) -> frozenset[int]:
        """The signals that lead to this one and to which it leads (its strongly connected component)."""
        found = self.cycles.get(signal)
        if found is None:
            found = frozenset(s for s in self.closed(signal) if signal in self.closed(s))
            for member in found:
                self.cycles[member] = found
        return found

    def pathways(self, signal: int, visited: frozenset[int]) -> list[Pathway]:
        """The pathways of a signal when those in `visited` are on the way already (cycles cut there)."""
        if signal in visited:
            return [frozenset()]
        cycle = self.cycle(signal)
        key = (signal, visited & cycle)
        found = self.known.get(key)
        if found is None:
            visited = key[1] | {signal}
            alternatives: dict[Pathway, None] = {}
            for conjunction in self.cause_signals[signal]:
                partial: list[Pathway] = [frozenset((signal,))]
                for cause in sorted(conjunction):
                    partial = self.product(partial, self.pathways(cause, visited))
                alternatives.update(dict.fromkeys(partial))
            found = self.known[key] = self.cheapest(alternatives)
        return found

    def product(self, left: list[Pathway], right: list[Pathway]) -> list[Pathway]:
        """Every union of one of `left` with one of `right`, without doubles, the cheapest first."""
        if len(right) == 1:
            only = right[0]
            return self.cheapest(dict.fromkeys(pathway | only for pathway in left)) if only else left
        return self.cheapest(dict.fromkeys(a | b for a in left for b in right))

    def cheapest(self, pathways: dict[Pathway, None]) -> list[Pathway]:
        if len(pathways) <= MAX_PATHWAYS:
            return list(pathways)
        information = self.information
        return sorted(pathways, key=lambda p: (math.fsum(information[s] for s in p), sorted(p)))[
            :MAX_PATHWAYS
        ]
