"""Limit the memory that models need in addition to their weights."""

from __future__ import annotations

import contextlib
import ctypes
import os
import threading

_ARENA_MAX = -8
"""The number of the option M_ARENA_MAX in glibc's malloc.h."""

_loaded = threading.Event()
"""Set if something large was loaded after the last `give_back`."""


def keep_few_heaps() -> None:
    """Let the threads of the process share two heaps; if the C library is not glibc, do nothing.

    By default glibc makes up to eight heaps per core. Each keeps tens of megabytes that a model has used in its thread.
    The environment variable ``MALLOC_ARENA_MAX`` takes precedence.
    """
    if "MALLOC_ARENA_MAX" not in os.environ:
        with contextlib.suppress(AttributeError, OSError, TypeError):
            ctypes.CDLL(None).mallopt(_ARENA_MAX, 2)


def note_load() -> None:
    """Note that a model, examples or a second database was loaded, which leaves tens of megabytes in the heap."""
    _loaded.set()


def give_back() -> None:
    """Return freed memory from the C library to the system; if the library is not glibc, do nothing.

    If nothing was loaded after the last call, do nothing: the process would soon take the same memory again.
    """
    if not _loaded.is_set():
        return
    _loaded.clear()
    try:
        trim = ctypes.CDLL(None).malloc_trim
    except (AttributeError, OSError, TypeError):
        return
    trim(0)
