"""A line: places in order. Most places join in one batch or return to the front, and so need no search."""

from __future__ import annotations

import heapq
from typing import Any


class Line:
    """A queue of places, which are tuples; the least one is the first."""

    __slots__ = ("_between", "_line")

    def __init__(self) -> None:
        self._line: list[Any] = []  # the first one last
        self._between: list[Any] = []  # a heap of the places that did not come before all others

    def join(self, places: list[Any]) -> None:
        """Add places."""
        if len(places) > 1:
            places.sort(reverse=True)
        line = self._line
        for place in places:
            if not line or place < line[-1]:
                line.append(place)
            else:
                heapq.heappush(self._between, place)

    def pop(self) -> Any:
        """Remove the first place, and return it."""
        line = self._line
        if self._between:
            if not line:
                line = self._line = sorted(self._between, reverse=True)
                self._between.clear()
            elif self._between[0] < line[-1]:
                return heapq.heappop(self._between)
        return line.pop()

    def clear(self) -> None:
        """Remove all places."""
        self._line.clear()
        self._between.clear()

    def __bool__(self) -> bool:
        return bool(self._line or self._between)
