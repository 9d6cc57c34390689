"""The wording of lists of names in messages."""

from __future__ import annotations

from collections.abc import Iterable

SHOWN = 8  # the maximum number of names that a list shows


def few(names: Iterable[str]) -> str:
    """Join names with commas, each name once; after the first eight, add how many more there are.

    Example:
        >>> few(["m:a", "m:b", "m:a"]), few(f"m:r{number}" for number in range(100))
        ('m:a, m:b', 'm:r0, m:r1, m:r2, m:r3, m:r4, m:r5, m:r6, m:r7 and 92 more')
    """
    found = list(dict.fromkeys(names))
    more = len(found) - SHOWN
    if more <= 1:  # one more name is as short as "and 1 more"
        return ", ".join(found)
    return f"{', '.join(found[:SHOWN])} and {more} more"
