"""All pathways of a clause (law L8), for explanations.

An *alternative* of a signal is a set of signals that together may cause it. To make a pathway of a signal, choose one
of its alternatives, and one pathway of each signal in this alternative. The union of the chosen pathways, together with
the signal itself, is a pathway of the signal. The signal alone is a pathway if it is an input or has no causes.

The search walks from a signal to its causes, and notes its *way*: the signals that it has passed. The way ends at a
signal that it has passed before, because the causes form a cycle there. So the pathways of a signal depend on the way
to the signal.

Only explanations need the pathways one by one. Utilities need less: `Completion` counts the rules that a signal leads
to, and `Least` finds the least pathway.
"""

from __future__ import annotations

import heapq
from collections.abc import Generator, Iterable
from typing import Any

from ravestate.declare.signal import Signal
from ravestate.policy.completion import Completion
from ravestate.policy.model import Clause, Need

MAX_PATHWAYS = 256  # the maximum number of pathways of a clause or signal; those with the least information are kept

MAX_UNIONS = 200_000
"""The maximum number of unions for one clause. A clause that needs more shows only its least pathway."""

Costs = dict[int, int]
"""Set of signals → the information of the set, in units."""

Search = Generator["Search", Costs, Costs]
"""A step of the search. It yields further steps and receives their results, so long chains need no deep recursion."""


class _Entangled(Exception):
    """A clause needs more than `MAX_UNIONS` unions."""


class Pathways:
    """Lists the pathways of a policy's clauses, with a cache."""

    def __init__(self, completion: Completion) -> None:
        self.completion = completion
        self._of_clauses: dict[Clause, tuple[frozenset[Signal[Any]], ...]] = {}
        self._known: dict[int, Costs] = {}
        self._within: dict[tuple[int, int], Costs] = {}  # (place, signals of the way on its cycle) → pathways
        self._unions = 0

    def of_clause(self, clause: Clause) -> tuple[frozenset[Signal[Any]], ...]:
        """Return the pathways of a clause, those with the least information first; at most `MAX_PATHWAYS`."""
        if clause in self._of_clauses:
            return self._of_clauses[clause]
        self._unions = 0
        try:
            found = _run(self._of_needs(clause.needs))
        except _Entangled:
            found = {}
        finally:
            self._within.clear()
        found[clause.least] = -1
        ordered = sorted(found, key=lambda pathway: (found[pathway], pathway))
        pathways = tuple(self.completion.signals(pathway) for pathway in ordered[:MAX_PATHWAYS])
        self._of_clauses[clause] = pathways
        return pathways

    def _of_needs(self, needs: Iterable[Need]) -> Search:
        found: Costs = {0: 0}
        for need in needs:
            place = self.completion.place[need.signal.index]
            if need.detached:  # the causes of a detached need's signal do not count
                found = self._product(found, {1 << place: self.completion.information[place]})
            else:
                found = self._product(found, (yield self._of_signal(place, 0)))
        return found

    def _of_signal(self, place: int, way: int) -> Search:
        """Find the pathways of the signal at `place`. `way` is the set of the signals through which the search came."""
        graph = self.completion
        alone = 1 << place
        if way & alone:
            return {0: 0}
        way &= graph.cycle[place]
        known = self._within.get((place, way)) if way else self._known.get(place)
        if known is not None:
            return known
        bare: Costs = {alone: graph.information[place]}
        found: Costs = dict(bare) if graph.bare[place] else {}
        for alternative in graph.alternatives[place]:
            partial = bare
            for cause in alternative:
                partial = self._product(partial, (yield self._of_signal(cause, way | alone)))
            found.update(partial)
        found = _cheapest(found)
        if way:
            self._within[place, way] = found
        else:
            self._known[place] = found
        return found

    def _product(self, left: Costs, right: Costs) -> Costs:
        """Return each union of a set of `left` with a set of `right`, with its information."""
        self._unions += len(left) * len(right)
        if self._unions > MAX_UNIONS:
            raise _Entangled
        found: Costs = {}
        for one, cost in left.items():
            for other, more in right.items():
                union = one | other
                if union not in found:
                    common = one & other
                    found[union] = cost + more - (self.completion.weigh(common) if common else 0)
        return _cheapest(found)


def _cheapest(found: Costs) -> Costs:
    if len(found) <= MAX_PATHWAYS:
        return found
    return {pathway: cost for cost, pathway in heapq.nsmallest(MAX_PATHWAYS, ((c, p) for p, c in found.items()))}


def _run(search: Search) -> Costs:
    """Run a step and all steps that it yields; return its result."""
    pending = [search]
    answer: Any = None
    while True:
        try:
            pending.append(pending[-1].send(answer))
            answer = None
        except StopIteration as finished:
            pending.pop()
            answer = finished.value
            if not pending:
                return answer
