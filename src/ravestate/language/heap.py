"""Free the memory that loading a model leaves behind."""

from __future__ import annotations

import ctypes


def give_back() -> None:
    """Return freed memory from the C library to the system; if the library is not glibc, do nothing.

    Loading a model leaves tens of megabytes in the heap of its thread.
    """
    try:
        trim = ctypes.CDLL(None).malloc_trim
    except (AttributeError, OSError, TypeError):
        return
    trim(0)
