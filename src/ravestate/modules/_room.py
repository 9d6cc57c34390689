"""Room in memory that was only needed while something was loaded."""

from __future__ import annotations

import ctypes

__all__ = ["give_back"]


def give_back() -> None:
    """Give the system back what the C library keeps of freed memory; where it is not glibc, do nothing.

    Loading models leaves tens of megabytes behind in the heaps of the threads that did it.
    """
    try:
        trim = ctypes.CDLL(None).malloc_trim
    except (AttributeError, OSError, TypeError):
        return
    trim(0)
