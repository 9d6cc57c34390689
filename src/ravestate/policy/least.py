"""The least pathway of a clause (law L9): the pathway with the least information.

An *alternative* of a signal is a set of signals that together may cause it. An input, or a signal without causes, also
has the empty alternative. A pathway is a set that holds an alternative of each of its signals. The *cost* of a set is
its information. A set of signals is an integer with one bit for each signal; `Completion` gives each signal its
*place*, the number of this bit.

The search begins with the set of the clause's own signals. Each step extends the sets of the previous step. In each
set, it takes the signal with the highest bit that still lacks an alternative, and tries each alternative of this
signal. If two sets agree in all signals that further steps can reach, these steps are the same for both. So the search
follows only the cheaper set, and independent choices do not multiply. The search for a signal uses the least pathways
of its causes. If the causes form a chain, a ring or a tree, the search takes one or two steps.

If alternatives have causes in common, the search is a weighted set cover problem, for which no quick method is known.
If a step leaves too many sets, the search follows only the cheapest sets, and the cost that it finds may be too high.
That happens only if dozens of choices depend on each other; the size of the policy does not matter.
"""

from __future__ import annotations

from collections.abc import Iterable

from ravestate.policy.completion import Completion, each
from ravestate.policy.components import components

EFFORT = 100_000
"""The number of sets that all searches of a policy together may examine, beyond the first `FREE` sets of each search.

Each search may examine a tenth of the number that is left, and divides this tenth among its steps.
"""

FREE = 100  # each search may examine this many sets, whatever is left of `EFFORT`


class Least:
    """Finds the least pathways of a policy: those of single signals first, causes before effects."""

    def __init__(self, completion: Completion) -> None:
        self.completion = completion
        self._effort = EFFORT
        self._open = 0
        """The set of *open* signals: those with several alternatives, none of which is empty."""
        self._whole = [1 << place for place in range(len(completion.bare))]
        """Signal → the set of the signal and all causes that follow without a choice between alternatives."""
        self._price = completion.information[:]
        """Signal → the information of its set in `_whole`."""
        self._reach: dict[int, int] = {}
        """Signal that has an open signal on its pathways → the union of its pathways."""
        self._masks: dict[int, list[int]] = {}
        """Open signal → its alternatives as sets."""
        self._known: dict[int, tuple[int, int]] = {}
        """Open signal, as a set → the cost of the other signals of its least pathway, and the set of these signals."""
        self._follow()
        for members in completion.components:
            self._settle([place for place in members if not completion.bare[place]])

    def pathway(self, firm: Iterable[int], looked_at: Iterable[int]) -> tuple[int, int]:
        """Return the information of a clause's least pathway, and the pathway as a set.

        `firm` has the places of the clause's non-detached signals. `looked_at` has the places of its detached signals,
        which need no completion.
        """
        free = _set(looked_at)
        cost, found = self._search(firm, free)
        return cost + self.completion.weigh(free), found | free

    def _follow(self) -> None:
        """Fill `_whole` and `_price`: find the causes that follow without a choice."""
        graph = self.completion
        forced = [
            found[0] if len(found) == 1 and not bare else ()
            for found, bare in zip(graph.alternatives, graph.bare, strict=True)
        ]
        for members in components(forced).members:  # causes first
            whole = _set(members)
            price = graph.weigh(whole)
            for place in members:
                whole, price = self._joined(whole, price, forced[place], 0)
            for place in members:
                self._whole[place], self._price[place] = whole, price

    def _settle(self, members: list[int]) -> None:
        """Find the least pathways of signals that lead to each other.

        The pathways of all other causes of these signals are known.
        """
        graph = self.completion
        choices = [place for place in members if len(graph.alternatives[place]) > 1]
        causes = {cause for place in members for found in graph.alternatives[place] for cause in found}
        if not choices and causes.isdisjoint(self._reach):
            return
        reach = _set(members)
        for cause in causes:
            reach |= self._reach.get(cause) or self._whole[cause]
        for place in members:
            self._reach[place] = reach
        for place in choices:
            self._open |= 1 << place
            self._masks[place] = [_set(alternative) for alternative in graph.alternatives[place]]
        for place in choices:
            cost, found = self._search((place,), 0)
            alone = 1 << place
            self._known[alone] = cost - graph.information[place], found ^ alone

    def _search(self, firm: Iterable[int], free: int) -> tuple[int, int]:
        """Return the cost and the set of the least completion of `firm`; signals in `free` cost nothing."""
        found, cost = self._joined(0, 0, firm, free)
        lacking = found & self._open
        if not lacking:
            return cost, found
        share = FREE + self._effort // 10
        room = max(1, share // (self._reached(lacking) & self._open).bit_count())
        looked = 0
        best: tuple[int, int] | None = None
        seen: dict[int, int] = {}
        steps = [(cost, found, self._lacking(lacking, found, found))]
        while steps:
            sets: dict[int, tuple[int, int, int]] = {}
            for cost, found, lacking in steps:
                reach = self._reached(lacking)
                matters = found & reach
                known = None if free & reach else self._known.get(matters)
                if known is not None:
                    cost, found, lacking = cost + known[0], found | known[1], 0
                if best is not None and cost >= best[0]:
                    continue
                if not lacking:
                    best = cost, found
                elif matters not in seen or cost < seen[matters]:
                    seen[matters] = cost
                    sets[matters] = cost, found, lacking
            steps = list[tuple[int, int, int]]()
            for cost, found, lacking in sorted(sets.values())[:room]:
                looked += 1
                place = lacking.bit_length() - 1
                for alternative in self.completion.alternatives[place]:
                    more, price = self._joined(found, cost, alternative, free)
                    steps.append((price, more, self._lacking(lacking ^ 1 << place, found, more)))
        self._effort = max(0, self._effort - max(0, looked - FREE))
        assert best is not None  # each step adds signals until every signal has an alternative
        return best

    def _joined(self, found: int, cost: int, places: Iterable[int], free: int) -> tuple[int, int]:
        """Add `places`, each with its `_whole`, to the set `found`. Return the set and its cost."""
        for place in places:
            whole = self._whole[place]
            more = whole & ~found
            if more:
                found |= more
                cost += self._price[place] if more == whole and not more & free else self.completion.weigh(more & ~free)
        return found, cost

    def _reached(self, lacking: int) -> int:
        reach = 0
        for place in each(lacking):
            reach |= self._reach[place]
        return reach

    def _lacking(self, lacking: int, before: int, found: int) -> int:
        """Return the open signals in the set `found` none of whose alternatives is a subset of `found`.

        `before` is the set before the last addition. `lacking` has the signals of `before` for which this may be true.
        """
        new = found & ~before
        left = lacking | new & self._open
        for place in each(left):
            if any(not mask & ~found for mask in self._masks[place]):
                left ^= 1 << place
        return left


def _set(places: Iterable[int]) -> int:
    bits = 0
    for place in places:
        bits |= 1 << place
    return bits
