"""How the interpreter shares its time while many talk at once."""

from __future__ import annotations

import contextlib
import gc
import sys
from collections.abc import Generator

__all__ = ["COLLECT", "SWITCH", "at_pace"]

SWITCH = 0.0005
"""Seconds after which a thread that computes lets others have their turn. An answer takes several turns of the event
loop, and while one sentence is read in a thread each of them would wait 5 ms, which is Python's own default."""

COLLECT = (10_000, 10, 10)
"""New objects, and rounds, after which those are looked for that only refer to each other. Python's own (700, 10, 10) looks
at everything that some hundred conversations hold every few seconds, and nobody is answered meanwhile."""

_users = 0
_before: tuple[float, tuple[int, int, int]] = (0.0, (0, 0, 0))


@contextlib.contextmanager
def at_pace() -> Generator[None]:
    """Within, the interpreter is set for short answers to many. It is as before once the last has left."""
    global _users, _before  # the interpreter has one of each, whoever serves
    if not _users:
        _before = sys.getswitchinterval(), gc.get_threshold()
        sys.setswitchinterval(SWITCH)
        gc.set_threshold(*COLLECT)
    _users += 1
    try:
        yield
    finally:
        _users -= 1
        if not _users:
            sys.setswitchinterval(_before[0])
            gc.set_threshold(*_before[1])
