"""The development sets of facts that users tell, with the scores of the blind set."""

from __future__ import annotations

from collections.abc import Iterable

from quality import blind
from quality.measure import Result

SETS = ("told_rows", "told_blind_rows", "told_fresh_rows")


def results() -> Iterable[Result]:
    """Measure the sets, and list their misses."""
    for name in SETS:
        yield from blind.measured_facts(f"../{name}", show=True)
