"""Whose turn it is: what one conversation hears is read in the order in which it was said."""

from __future__ import annotations

import asyncio

__all__ = ["Turn"]


class Turn(asyncio.Lock):
    """A lock that those who wait get in the order of their coming, as each of asyncio's; each context has its own."""

    def __deepcopy__(self, memo: object) -> Turn:
        return Turn()

    def __repr__(self) -> str:
        return "taken" if self.locked() else "free"
