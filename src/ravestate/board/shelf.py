"""The recordings that a server holds: those it was started with, and those that browsers have sent to be looked at."""

from __future__ import annotations

import secrets
from collections import OrderedDict

from ravestate.board.trace_file import Recording

__all__ = ["Shelf"]

KEPT = 4
"""Recordings that were sent and are kept: the newest."""


class Shelf:
    """Recordings by their names, which cannot be guessed.

    Args:
        first: What is shown to who asks for nothing else, if anything.
    """

    def __init__(self, first: Recording | None = None) -> None:
        self._first = first
        self._sent: OrderedDict[str, Recording] = OrderedDict()

    def get(self, name: str | None) -> Recording | None:
        """A recording by its name; the first without one."""
        return self._first if name is None else self._sent.get(name)

    def put(self, recording: Recording) -> str:
        """Keep a recording; its name."""
        name = secrets.token_urlsafe(12)
        self._sent[name] = recording
        while len(self._sent) > KEPT:
            self._sent.popitem(last=False)
        return name
