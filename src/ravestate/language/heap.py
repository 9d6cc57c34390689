"""Limit the memory that models need in addition to their weights."""

from __future__ import annotations

import contextlib
import ctypes
import os
import threading

SETTLED = 1.0
"""Freed memory goes back to the system this many seconds after the last load."""

_OPTIONS = ((-8, "MALLOC_ARENA_MAX", 2), (-3, "MALLOC_MMAP_THRESHOLD_", 2**19))
"""Options of glibc: the number in malloc.h, the environment variable and the value.

The first option is the maximum number of heaps. The second is a size in bytes: glibc keeps blocks of at least this size
outside the heaps.
"""

_lock = threading.Lock()
_pending: list[threading.Timer] = []
"""The timer for the next return of memory to the system; the list has at most one."""


def keep_few_heaps() -> None:
    """Let the threads of the process share two heaps, and keep large blocks out of them.

    By default, glibc makes up to eight heaps per core. Each heap keeps tens of megabytes that a model has used.
    Glibc also puts ever larger blocks into the heaps. A freed block between small blocks cannot go back to the system.
    The environment variables ``MALLOC_ARENA_MAX`` and ``MALLOC_MMAP_THRESHOLD_`` take precedence. If the C library is
    not glibc, do nothing.
    """
    for option, name, value in _OPTIONS:
        if name not in os.environ:
            with contextlib.suppress(AttributeError, OSError, TypeError):
                ctypes.CDLL(None).mallopt(option, value)


def note_load() -> None:
    """Note that a model, examples or a database was loaded, which leaves tens of megabytes of freed memory.

    If nothing else is loaded for `SETTLED` seconds, a thread returns this memory to the system. Otherwise, the next
    load can use it again.
    """
    timer = threading.Timer(SETTLED, give_back)
    timer.daemon = True  # the timer must not keep the process alive
    with _lock:
        for earlier in _pending:
            earlier.cancel()
        _pending[:] = [timer]
        timer.start()


def give_back() -> None:
    """Return freed memory from the C library to the system. If the library is not glibc, do nothing."""
    with contextlib.suppress(AttributeError, OSError, TypeError):
        ctypes.CDLL(None).malloc_trim(0)
