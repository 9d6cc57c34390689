"""The number of cores for the threads of a model."""

from __future__ import annotations

import os


def cores() -> int:
    """Return the number of cores that this process may use. The variable ``OMP_NUM_THREADS`` can lower this number.

    More threads than cores would only wait for each other.
    """
    allowed = getattr(os, "sched_getaffinity", None)  # only Linux has this function
    found = len(allowed(0)) if allowed is not None else os.cpu_count() or 1
    wanted = os.environ.get("OMP_NUM_THREADS", "").partition(",")[0].strip()
    return min(found, int(wanted)) if wanted.isdecimal() and int(wanted) else found
