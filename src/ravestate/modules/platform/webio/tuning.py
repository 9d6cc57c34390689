"""How the interpreter shares its time while many talk at once."""

from __future__ import annotations

import contextlib
import gc
import sys
from collections.abc import Generator
from dataclasses import dataclass

__all__ = ["COLLECT", "SWITCH", "low_latency"]

SWITCH = 0.0005
"""Seconds after which a thread that computes lets others have their turn. An answer takes several turns of the event
loop, and while one sentence is read in a thread each of them would wait 5 ms, which is Python's own default."""

COLLECT = (10_000, 10, 10)
"""New objects, and rounds, after which those are looked for that only refer to each other. Python's own (700, 10, 10) looks
at everything that some hundred conversations hold every few seconds, and nobody is answered meanwhile."""


@dataclass(slots=True)
class _Saved:
    """How many serve, and what was set before the first of them. The interpreter has one of each, whoever serves."""

    users: int = 0
    switch: float = 0.0
    collect: tuple[int, int, int] = (0, 0, 0)


_saved = _Saved()


@contextlib.contextmanager
def low_latency() -> Generator[None]:
    """Within, the interpreter is set for short answers to many. It is as before once the last has left."""
    if not _saved.users:
        _saved.switch, _saved.collect = sys.getswitchinterval(), gc.get_threshold()
        sys.setswitchinterval(SWITCH)
        gc.set_threshold(*COLLECT)
    _saved.users += 1
    try:
        yield
    finally:
        _saved.users -= 1
        if not _saved.users:
            sys.setswitchinterval(_saved.switch)
            gc.set_threshold(*_saved.collect)
