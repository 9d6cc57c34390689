"""A line: a queue of activations in the order of their sort keys.

Most activations join in one batch, or join at the front. The others join a heap, which is seldom needed.
"""

from __future__ import annotations

import heapq
from typing import Any


class Line:
    """A queue of *places*. A place is a tuple: a sort key, then the activation. The least place is the first.

    Attributes:
        line: The places that joined at the front of the queue, or came from the heap later. They are in reverse order:
            the first place is at the end. This list is empty only if the queue is empty.
    """

    __slots__ = ("_between", "line")

    def __init__(self) -> None:
        self.line: list[Any] = []
        self._between: list[Any] = []  # a heap of the other places

    def join(self, places: list[Any]) -> None:
        """Add places."""
        if len(places) > 1:
            places.sort(reverse=True)
        line = self.line
        for place in places:
            if not line or place < line[-1]:
                line.append(place)
            else:
                heapq.heappush(self._between, place)

    def take(self) -> Any:
        """Remove the first place, and return it. The queue must not be empty."""
        line, between = self.line, self._between
        if between:
            if between[0] < line[-1]:
                return heapq.heappop(between)
            if len(line) == 1:
                line += sorted(between, reverse=True)
                between.clear()
                return line.pop(0)
        return line.pop()

    def clear(self) -> None:
        """Remove all places."""
        self.line.clear()
        self._between.clear()
