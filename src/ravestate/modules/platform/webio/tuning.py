"""Interpreter settings for quick answers to many visitors."""

from __future__ import annotations

import contextlib
import gc
import sys
from collections.abc import Generator
from dataclasses import dataclass

SWITCH = 0.0005
"""The seconds after which a computing thread gives way to another. An answer takes several turns of the event loop.
With Python's default, each turn would wait 5 ms while a thread analyses a sentence."""

COLLECT = (10_000, 10, 10)
"""The thresholds of the cyclic garbage collector. With Python's default (700, 10, 10), it would scan all objects of
several hundred conversations every few seconds, and hold up all answers meanwhile."""


@dataclass(slots=True)
class _Saved:
    """The number of running servers, and the interpreter's settings from before the first server."""

    users: int = 0
    switch: float = 0.0
    collect: tuple[int, int, int] = (0, 0, 0)


_saved = _Saved()


@contextlib.contextmanager
def low_latency() -> Generator[None]:
    """Tune the interpreter for quick answers in the body, until the last server that does so has ended."""
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
