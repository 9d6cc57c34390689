"""The recordings that a server holds: the one that it was started with, and uploaded ones."""

from __future__ import annotations

import secrets
from collections import OrderedDict

from ravestate.board.trace_file import Recording

KEPT = 4
"""The maximum number of uploaded recordings; the newest are kept."""


class Recordings:
    """Recordings by their unguessable names.

    Args:
        first: The recording to show without a name, if any.
    """

    def __init__(self, first: Recording | None = None) -> None:
        self._first = first
        self._uploaded: OrderedDict[str, Recording] = OrderedDict()

    def get(self, name: str | None) -> Recording | None:
        """Return a recording by its name, or the first one for None."""
        return self._first if name is None else self._uploaded.get(name)

    def put(self, recording: Recording) -> str:
        """Keep a recording, and return its name."""
        name = secrets.token_urlsafe(12)
        self._uploaded[name] = recording
        while len(self._uploaded) > KEPT:
            self._uploaded.popitem(last=False)
        return name
