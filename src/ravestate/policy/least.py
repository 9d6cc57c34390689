"""The least pathway of a clause (L9): which alternatives make the information of their union least.

A pathway is a set that holds an alternative of each of its signals (`Completion`). The search begins with the
clause's own signals, and each step completes the highest signal that lacks an alternative, in every way. Two sets
have the same future if they agree in what may still matter to the signals that lack one; only the cheaper of them is
followed, so that choices which have nothing to do with each other do not multiply. In a chain, a ring or a tree the
least pathway is known after a step or two from that of its causes.

To choose causes that have causes in common is the weighted set cover problem: nobody knows a way that is quick on every
policy. If after a step more sets are left than there is room for, the cheapest are followed. Until then, and that is
for policies of any size whose choices are not entangled by the dozen, what is found is exact.
"""

from __future__ import annotations

from collections.abc import Iterable

from ravestate.policy.completion import Completion, each
from ravestate.policy.components import components

__all__ = ["EFFORT", "Least"]

EFFORT = 100_000
"""Sets that may be looked at, for a whole policy, beyond the first `FREE` of each search. A search makes itself as much
room as a tenth of what is left allows it for each step."""

FREE = 100


class Least:
    """The least pathways of a policy; those of single signals are found first, causes before effects."""

    __slots__ = ("_effort", "_known", "_masks", "_open", "_price", "_reach", "_whole", "completion")

    def __init__(self, completion: Completion) -> None:
        self.completion = completion
        self._effort = EFFORT
        self._open = 0
        """The signals that have several alternatives: there the choices are."""
        self._whole = [1 << place for place in range(len(completion.bare))]
        """For each signal itself and what it cannot do without, as far as the next choices."""
        self._price = completion.information[:]
        """What that costs."""
        self._reach: dict[int, int] = {}
        """For each signal that is open, or that leads to one, what its pathways may consist of."""
        self._masks: dict[int, list[int]] = {}
        """For each open signal its alternatives, as sets."""
        self._known: dict[int, tuple[int, int]] = {}
        """For what may matter still: what its completion costs, and that completion."""
        self._follow()
        for members in completion.components:
            self._settle([place for place in members if not completion.bare[place]])

    def pathway(self, firm: Iterable[int], looked_at: Iterable[int]) -> tuple[int, int]:
        """The least pathway of a clause: its information, and the set.

        Args:
            firm: The places of the signals that are to be completed.
            looked_at: The places of those that are detached: they are on the pathway as they are.
        """
        free = _set(looked_at)
        cost, found = self._search(firm, free)
        return cost + self.completion.weigh(free), found | free

    def _follow(self) -> None:
        """Find what signals with a single alternative cannot do without."""
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
        """Find the least pathways of signals that lead to each other, all other causes being settled."""
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
        """The least set that holds `firm` and an alternative of each signal, where those in `free` cost nothing."""
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
        assert best is not None  # every signal has an alternative, and sets grow until they hold all
        return best

    def _joined(self, found: int, cost: int, places: Iterable[int], free: int) -> tuple[int, int]:
        """A set and what it costs, with signals added whose pathway is known."""
        for place in places:
            whole = self._whole[place]
            more = whole & ~found
            if more:
                found |= more
                cost += (
                    self._price[place]
                    if more == whole and not more & free
                    else self.completion.weigh(more & ~free)
                )
        return found, cost

    def _reached(self, lacking: int) -> int:
        reach = 0
        for place in each(lacking):
            reach |= self._reach[place]
        return reach

    def _lacking(self, lacking: int, before: int, found: int) -> int:
        """The signals that lack an alternative, of those that lacked one and those that are new since `before`."""
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
