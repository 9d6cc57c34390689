"""The queue of the ready activations that need no consent: they start in the order of their newest spikes (L21)."""

from __future__ import annotations

import heapq
from collections import deque

from ravestate.engine.activation import READY, Activation

Place = tuple[int, int, int, Activation]


class Free:
    """A queue of ready activations. Most join at its end; those that lost a spike and took another join anywhere.

    Attributes:
        new: The activations without a place so far.
        line: The places of the others, in order. It is empty only if all activations are in `new`.
    """

    __slots__ = ("_between", "line", "new")

    def __init__(self) -> None:
        self.new: list[Activation] = []
        self.line: deque[Place] | None = None  # made on first use: an empty one takes 600 bytes
        self._between: list[Place] = []  # a heap

    def pop(self) -> Activation | None:
        """Remove the first activation that is still ready, and return it; None if there is none."""
        new, line, between = self.new, self.line, self._between
        if len(new) == 1 and not line:
            activation = new.pop()
            return activation if activation.state == READY else None
        if not (new or line):
            return None
        if line is None:
            line = self.line = deque[Place]()
        for activation in new:
            self._join(activation, line)
        new.clear()
        while line:
            place = heapq.heappop(between) if between and between[0] < line[0] else line.popleft()
            if between and not line:
                line.extend(sorted(between))
                between.clear()
            activation = place[3]
            if activation.place == place:  # else it was added again since
                activation.place = None
                if activation.state == READY:
                    return activation
        return None

    def _join(self, activation: Activation, line: deque[Place]) -> None:
        """Give an activation its place: first in the order of its newest spike, then of declaration."""
        newest = max([spike.id for spike in activation.spikes if spike is not None], default=0)
        place = activation.place = (newest, activation.clause.index, activation.id, activation)
        if not line or line[-1] < place:
            line.append(place)
        else:
            heapq.heappush(self._between, place)

    def __bool__(self) -> bool:
        return bool(self.new or self.line)
