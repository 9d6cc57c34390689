"""What do unrelated rules cost?

The agent of ``answer`` (a chain of one rule) runs beside 10 and beside 10,000 rules, each with a signal of its own.
Each case has its own process, so that neither case pays for the memory of the other.
"""

from __future__ import annotations

import statistics
from collections.abc import Iterable

from benchmarks.bench import Bench
from benchmarks.figures import Figure, compare

FEW, MANY = 10, 10_000


def ask(bench: Bench) -> Iterable[Figure]:
    """Compare an input beside many rules with an input beside few rules."""
    small, large = bench.ours(), bench.ours()
    few, many = [], []
    inputs = bench.several(100, 50)
    for _ in bench.rounds(25, 5):
        few.append(statistics.median(small.ask("answer", k=1, inputs=inputs, unrelated=FEW)["answered"]))
        many.append(statistics.median(large.ask("answer", k=1, inputs=inputs, unrelated=MANY)["answered"]))
    yield compare(
        "unrelated",
        f"answered beside {MANY:,} rules",
        many,
        f"beside {FEW}",
        few,
        target="<= 1.5",
        reach=lambda ratio: ratio <= 1.5,
    )
