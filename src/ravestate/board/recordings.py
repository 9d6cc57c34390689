"""The recordings that a server holds: the one with which it was started, and uploaded recordings."""

from __future__ import annotations

import secrets
from collections import OrderedDict

from ravestate.board.trace_file import Recording

KEPT = 4  # the maximum number of uploaded recordings that a server keeps: the newest ones


class Recordings:
    """A table of recordings by their names, which nobody can guess.

    Args:
        first: The recording for a request without a name; None if there is none.
    """

    def __init__(self, first: Recording | None = None) -> None:
        self._first = first
        self._uploaded: OrderedDict[str, Recording] = OrderedDict()

    def get(self, name: str | None) -> Recording | None:
        """Return the recording with this name, or the first one if the name is None; None if there is none."""
        return self._first if name is None else self._uploaded.get(name)

    def put(self, recording: Recording) -> str:
        """Keep an uploaded recording, and return its new name."""
        name = secrets.token_urlsafe(12)
        self._uploaded[name] = recording
        while len(self._uploaded) > KEPT:
            self._uploaded.popitem(last=False)
        return name
