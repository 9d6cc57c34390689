"""Keep the memory small that models need, beside their weights."""

from __future__ import annotations

import contextlib
import ctypes

_MMAP_THRESHOLD, _ARENA_MAX = -3, -8
"""The numbers of the options in glibc's malloc.h."""

LARGE = 128 * 1024
"""The size in bytes from which a block of memory goes back to the system as soon as it is free."""


def keep_few_heaps() -> None:
    """Let the threads of the process share two heaps; if the C library is not glibc, do nothing.

    By default glibc makes up to eight heaps per core. Each keeps tens of megabytes that a model has used in its thread.
    """
    with contextlib.suppress(AttributeError, OSError, TypeError):
        libc = ctypes.CDLL(None)
        libc.mallopt(_ARENA_MAX, 2)
        libc.mallopt(_MMAP_THRESHOLD, LARGE)


def give_back() -> None:
    """Return freed memory from the C library to the system; if the library is not glibc, do nothing.

    Loading a model leaves tens of megabytes in the heap of its thread.
    """
    try:
        trim = ctypes.CDLL(None).malloc_trim
    except (AttributeError, OSError, TypeError):
        return
    trim(0)
