"""Phrases with alternatives."""

from __future__ import annotations

import re
from itertools import product

_ALTERNATIVES = re.compile(r"\(([^()]*)\)")


def phrases(patterns: str) -> list[tuple[str, ...]]:
    """Return all phrases of `patterns`, as words. Semicolons separate patterns.

    Example:
        >>> phrases("(it|that) is (|very) good; fine")[1:]
        [('it', 'is', 'very', 'good'), ('that', 'is', 'good'), ('that', 'is', 'very', 'good'), ('fine',)]
    """
    found: list[tuple[str, ...]] = []
    for pattern in patterns.split(";"):
        fixed = _ALTERNATIVES.split(pattern)  # parentheses are at odd places
        choices = [part.split("|") if place % 2 else [part] for place, part in enumerate(fixed)]
        found += [phrase for chosen in product(*choices) if (phrase := tuple("".join(chosen).split()))]
    return found
