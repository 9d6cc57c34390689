"""The queue of the ready activations that need no consent: they start in the order of their newest spikes (L21)."""

from __future__ import annotations

import heapq
from collections import deque

from ravestate.engine.activation import READY, Activation

Place = tuple[int, int, int]


class Free:
    """A queue of ready activations. Most join at its end; those that lost a spike and took another join anywhere."""

    __slots__ = ("_between", "_line")

    def __init__(self) -> None:
        self._line: deque[tuple[Place, Activation]] = deque()
        self._between: list[tuple[Place, Activation]] = []  # a heap

    def add(self, activation: Activation) -> None:
        """Add a ready activation."""
        entry = (_place(activation), activation)
        if not self._line or self._line[-1] < entry:
            self._line.append(entry)
        else:
            heapq.heappush(self._between, entry)

    def pop(self) -> Activation | None:
        """Remove the first activation that is still ready, and return it; None if there is none."""
        while self._line or self._between:
            if self._between and (not self._line or self._between[0] < self._line[0]):
                place, activation = heapq.heappop(self._between)
            else:
                place, activation = self._line.popleft()
            if activation.state is READY:
                if place == _place(activation):
                    return activation
                self.add(activation)
        return None

    def __len__(self) -> int:
        return len(self._line) + len(self._between)


def _place(activation: Activation) -> Place:
    """Return the sort key of an activation: its newest spike, then the order of declaration."""
    spikes = activation.spikes
    if len(spikes) == 1:
        newest = 0 if spikes[0] is None else spikes[0].id
    else:
        newest = max([spike.id for spike in spikes if spike is not None], default=0)
    return (newest, activation.clause.index, activation.id)
