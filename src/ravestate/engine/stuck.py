"""Activations that count as doing nothing, because they wait only for each other (``stalemate.py``)."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from ravestate.engine.activation import Activation


class Stuck:
    """A set of activations, in the order in which they joined.

    `counts`: index of a rule → how many members are activations of this rule.
    """

    __slots__ = ("_members", "counts")

    def __init__(self, members: Iterable[Activation] = ()) -> None:
        self._members: dict[Activation, None] = {}
        self.counts: dict[int, int] = {}
        for member in members:
            self.add(member)

    def add(self, activation: Activation) -> None:
        """Add an activation."""
        if activation not in self._members:
            self._members[activation] = None
            rule = activation.clause.rule.index
            self.counts[rule] = self.counts.get(rule, 0) + 1

    def discard(self, activation: Activation) -> None:
        """Remove an activation, if it is a member."""
        if activation in self._members:
            del self._members[activation]
            rule = activation.clause.rule.index
            self.counts[rule] -= 1

    def clear(self) -> None:
        """Remove all activations."""
        self._members.clear()
        self.counts.clear()

    def __contains__(self, activation: object) -> bool:
        return activation in self._members

    def __iter__(self) -> Iterator[Activation]:
        return iter(self._members)

    def __len__(self) -> int:
        return len(self._members)
