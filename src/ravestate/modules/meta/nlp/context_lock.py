"""A fair lock for each context: one conversation's utterances are analysed in the order in which they came."""

from __future__ import annotations

import asyncio


class ContextLock(asyncio.Lock):
    """A first-in, first-out lock that each context copies for itself."""

    def __deepcopy__(self, memo: object) -> ContextLock:
        return ContextLock()

    def __repr__(self) -> str:
        return "taken" if self.locked() else "free"
